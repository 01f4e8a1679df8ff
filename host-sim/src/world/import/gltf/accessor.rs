//! Reading the numbers of a glTF accessor, bounded by the bytes of its buffer.

use ::gltf::Accessor;
use ::gltf::accessor::{DataType, Dimensions};

/// The points of an accessor of three floats each; or why it can't be read.
pub(super) fn points(accessor: &Accessor<'_>, buffers: &[Option<Vec<u8>>]) -> Result<Vec<[f32; 3]>, String> {
    if (accessor.dimensions(), accessor.data_type()) != (Dimensions::Vec3, DataType::F32) {
        return Err("are not triples of floats".to_owned());
    }
    let float = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    Ok(elements(accessor, buffers)?.map(|bytes| [float(bytes), float(&bytes[4..]), float(&bytes[8..])]).collect())
}

/// The indices of an accessor of unsigned integers; or why it can't be read.
pub(super) fn indices(accessor: &Accessor<'_>, buffers: &[Option<Vec<u8>>]) -> Result<Vec<u32>, String> {
    let index: fn(&[u8]) -> u32 = match (accessor.dimensions(), accessor.data_type()) {
        (Dimensions::Scalar, DataType::U8) => |bytes| u32::from(bytes[0]),
        (Dimensions::Scalar, DataType::U16) => |bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        (Dimensions::Scalar, DataType::U32) => |bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        _ => return Err("are not unsigned integers".to_owned()),
    };
    Ok(elements(accessor, buffers)?.map(index).collect())
}

/// The bytes of each element, all of the accessor's element size.
fn elements<'b>(
    accessor: &Accessor<'_>,
    buffers: &'b [Option<Vec<u8>>],
) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, String> {
    if accessor.sparse().is_some() {
        return Err("are sparse, which is not read".to_owned());
    }
    let view = accessor.view().ok_or("name no buffer")?;
    let buffer =
        buffers.get(view.buffer().index()).and_then(Option::as_ref).ok_or("lie in a buffer that can't be read")?;
    let end = view.offset().checked_add(view.length()).ok_or("reach beyond their buffer")?;
    let bytes = buffer.get(view.offset()..end).ok_or("reach beyond their buffer")?;
    let bytes = bytes.get(accessor.offset()..).ok_or("reach beyond their part of the buffer")?;
    let (size, count) = (accessor.size(), accessor.count());
    let stride = view.stride().unwrap_or(size);
    if stride < size {
        return Err("overlap".to_owned());
    }
    let needed = count.saturating_sub(1).checked_mul(stride).and_then(|last| last.checked_add(size));
    if count > 0 && needed.is_none_or(|needed| needed > bytes.len()) {
        return Err("reach beyond their part of the buffer".to_owned());
    }
    Ok((0..count).map(move |index| &bytes[index * stride..index * stride + size]))
}

//! As much of HTTP/1.1 as one page on the same machine needs: a request, an answer, the end.

use std::io::{self, Read, Write};

/// Longest head of a request, in bytes.
const MAX_HEAD_BYTES: usize = 16 << 10;

/// Longest body of a request, in bytes: the numbers of a million edges.
const MAX_BODY_BYTES: usize = 8 << 20;

/// The most header fields of a request.
const MAX_FIELDS: usize = 64;

/// A request as it came.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) method: String,
    /// What follows the host in the address.
    pub(super) target: String,
    pub(super) host: String,
    /// The page that asks, if the browser tells.
    pub(super) origin: Option<String>,
    pub(super) body: Vec<u8>,
}

/// An answer.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) status: &'static str,
    pub(super) content_type: &'static str,
    pub(super) body: Vec<u8>,
}

/// Reads one request; none when it breaks the rules, is too long or never ends.
pub(super) fn read(stream: &mut impl Read) -> Option<Request> {
    let mut bytes = Vec::new();
    let (mut request, body_start, body_length) = loop {
        read_some(stream, &mut bytes)?;
        let head = parse_head(&bytes).ok()?;
        if let Some(head) = head {
            break head;
        }
        if bytes.len() > MAX_HEAD_BYTES {
            return None;
        }
    };
    while bytes.len() < body_start + body_length {
        read_some(stream, &mut bytes)?;
    }
    request.body = bytes.get(body_start..body_start + body_length)?.to_vec();
    Some(request)
}

/// The request without its body, where that begins and how long it is; none when the head is not complete.
fn parse_head(bytes: &[u8]) -> Result<Option<(Request, usize, usize)>, httparse::Error> {
    let mut fields = [httparse::EMPTY_HEADER; MAX_FIELDS];
    let mut head = httparse::Request::new(&mut fields);
    let httparse::Status::Complete(length) = head.parse(bytes)? else { return Ok(None) };
    let mut request = Request {
        method: head.method.unwrap_or_default().to_owned(),
        target: head.path.unwrap_or_default().to_owned(),
        host: String::new(),
        origin: None,
        body: Vec::new(),
    };
    let (mut host_count, mut body_length) = (0, 0);
    for field in head.headers.iter() {
        let value = || std::str::from_utf8(field.value).map_err(|_| httparse::Error::HeaderValue);
        if field.name.eq_ignore_ascii_case("host") {
            host_count += 1;
            value()?.clone_into(&mut request.host);
        } else if field.name.eq_ignore_ascii_case("origin") {
            request.origin = Some(value()?.to_owned());
        } else if field.name.eq_ignore_ascii_case("content-length") {
            let length = value()?.parse::<usize>().ok().filter(|length| *length <= MAX_BODY_BYTES);
            body_length = length.ok_or(httparse::Error::HeaderValue)?;
        } else if field.name.eq_ignore_ascii_case("transfer-encoding") {
            return Err(httparse::Error::HeaderValue);
        }
    }
    if host_count == 1 { Ok(Some((request, length, body_length))) } else { Err(httparse::Error::HeaderName) }
}

fn read_some(stream: &mut impl Read, bytes: &mut Vec<u8>) -> Option<()> {
    let mut chunk = [0; 8 << 10];
    let length = stream.read(&mut chunk).ok().filter(|length| *length > 0)?;
    bytes.extend(&chunk[..length]);
    Some(())
}

/// Writes an answer; the browser is told to let nothing in from elsewhere and to keep nothing.
pub(super) fn write(stream: &mut impl Write, answer: &Answer) -> io::Result<()> {
    let Answer { status, content_type, body } = answer;
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {content_type}\r\nContent-Length: {}\r\nConnection: close\r\n\
         Cache-Control: no-store\r\nReferrer-Policy: same-origin\r\nX-Content-Type-Options: nosniff\r\n\
         X-Frame-Options: DENY\r\nCross-Origin-Resource-Policy: same-origin\r\n\
         Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
         img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\r\n",
        body.len()
    )?;
    stream.write_all(body)?;
    stream.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A connection that brings one byte at a time.
    struct Slow<'a>(&'a [u8]);

    impl Read for Slow<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let length = self.0.len().min(1);
            buffer[..length].copy_from_slice(&self.0[..length]);
            self.0 = &self.0[length..];
            Ok(length)
        }
    }

    #[test]
    fn a_request_is_read_in_whatever_pieces_it_comes() {
        let text = b"POST /a?b=1 HTTP/1.1\r\nHost: h:1\r\norigin: http://h:1\r\nContent-Length: 3\r\n\r\n[1]more";
        let request = read(&mut &text[..]).expect("a request");
        assert_eq!(
            (request.method.as_str(), request.target.as_str(), request.host.as_str()),
            ("POST", "/a?b=1", "h:1")
        );
        assert_eq!((request.origin.as_deref(), &request.body[..]), (Some("http://h:1"), &b"[1]"[..]));
        assert_eq!(read(&mut Slow(text)), Some(request));
    }

    #[test]
    fn what_is_no_plain_request_is_refused() {
        let long = format!("GET / HTTP/1.1\r\nHost: h\r\nX: {}", "x".repeat(1 << 20));
        for text in [
            "",
            "GET / HTTP/1.1\r\nHost: h\r\n",
            "GET / HTTP/1.1\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
            "POST / HTTP/1.1\r\nHost: h\r\nContent-Length: 5\r\n\r\n[1]",
            "POST / HTTP/1.1\r\nHost: h\r\nContent-Length: 99999999999999999999\r\n\r\n",
            "POST / HTTP/1.1\r\nHost: h\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
            &long,
        ] {
            assert_eq!(read(&mut text.as_bytes()), None, "{text:.60}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_whatever_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = read(&mut &bytes[..]);
            let _ = read(&mut &[b"GET / HTTP/1.1\r\nHost: h\r\n".to_vec(), bytes].concat()[..]);
        }
    }
}

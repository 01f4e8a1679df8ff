//! `trials.csv`: one line a trial, the record first and then the parameters that were applied in it.
//!
//! The columns of the parameters are named by their keys in a scenario file (`localizer.score_margin`), so that the table
//! alone tells what was run; reading it back checks that they are those of the scenario beside it.

use crate::monte_carlo::TrialRecord;
use crate::scenario::Setting;
use std::collections::BTreeMap;

/// The parameters of a run: which there are, in columns, and their values in each row.
struct Parameters {
    columns: Vec<String>,
    values_of_row: BTreeMap<String, Vec<String>>,
}

impl Parameters {
    /// A parameter that some row does not know is empty there.
    fn of(settings: &[Setting]) -> Self {
        let rows: Vec<_> = settings.iter().map(|setting| (&setting.row.name, setting.parameters())).collect();
        let mut columns: Vec<String> = Vec::new();
        for (key, _) in rows.iter().flat_map(|(_, parameters)| parameters) {
            if !columns.contains(key) {
                columns.push(key.clone());
            }
        }
        let value = |parameters: &[(String, String)], column: &String| {
            parameters.iter().find(|(key, _)| key == column).map(|(_, value)| value.clone()).unwrap_or_default()
        };
        let values = |parameters: &[(String, String)]| columns.iter().map(|column| value(parameters, column)).collect();
        let values_of_row = rows.iter().map(|(row, parameters)| ((*row).clone(), values(parameters))).collect();
        Self { columns, values_of_row }
    }

    fn values(&self, row: &str) -> Result<&[String], String> {
        self.values_of_row.get(row).map(Vec::as_slice).ok_or_else(|| format!("the scenario has no row {row:?}"))
    }
}

/// The table of `records`, trials of `settings`.
pub(super) fn write(records: &[TrialRecord], settings: &[Setting]) -> Result<Vec<u8>, csv::Error> {
    let parameters = Parameters::of(settings);
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (index, record) in records.iter().enumerate() {
        let mut own = csv::Writer::from_writer(Vec::new());
        own.serialize(record)?;
        let own = own.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
        let mut lines = csv::ReaderBuilder::new().has_headers(false).from_reader(&own[..]).into_records();
        let (Some(header), Some(line)) = (lines.next().transpose()?, lines.next().transpose()?) else { continue };
        let values = parameters.values(&record.row).map_err(std::io::Error::other)?;
        if index == 0 {
            writer.write_record(header.iter().chain(parameters.columns.iter().map(String::as_str)))?;
        }
        writer.write_record(line.iter().chain(values.iter().map(String::as_str)))?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

/// The records of a table written by trials of `settings`.
pub(super) fn read(text: &str, settings: &[Setting]) -> Result<Vec<TrialRecord>, String> {
    let parameters = Parameters::of(settings);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let mut records = Vec::new();
    for line in reader.records() {
        let line = line.map_err(|error| error.to_string())?;
        let record: TrialRecord = line.deserialize(Some(&header)).map_err(|error| error.to_string())?;
        let own = header.len().checked_sub(parameters.columns.len()).ok_or("columns are missing")?;
        for (place, (key, value)) in parameters.columns.iter().zip(parameters.values(&record.row)?).enumerate() {
            if header.get(own + place) != Some(key) || line.get(own + place) != Some(value) {
                let found = line.get(own + place).unwrap_or_default();
                let (row, trial) = (&record.row, record.trial);
                return Err(format!("row {row:?}, trial {trial} ran with {key} = {found}, the scenario says {value}"));
            }
        }
        records.push(record);
    }
    Ok(records)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn a_line_tells_what_was_run_and_another_scenario_is_found_out() {
        let results = sample::run().results;
        let settings = results.scenario.settings().expect("legal");
        let bytes = write(&results.records, &settings).expect("written");
        let text = String::from_utf8(bytes).expect("UTF-8");
        let header = text.lines().next().expect("a header");
        for column in ["row", "message", "start", "localizer.kind", "uncertainty.stereo_match.magnitude", "seed"] {
            assert!(header.split(',').any(|found| found == column), "{column} in {header}");
        }
        assert_eq!(read(&text, &settings).as_ref(), Ok(&results.records));

        let mut other = results.scenario.clone();
        other.localizer.score_margin = 0.2;
        let error = read(&text, &other.settings().expect("legal")).expect_err("another scenario");
        assert!(error.contains("localizer.score_margin = 0.1") && error.contains("says 0.2"), "{error}");
    }

    #[test]
    fn a_row_name_of_quotes_and_a_message_over_two_lines_come_back() {
        let mut results = sample::run().results;
        results.scenario.rows.truncate(1);
        results.scenario.rows[0].name = "\"a\", b".to_owned();
        results.records.truncate(1);
        results.records[0].row = "\"a\", b".to_owned();
        results.records[0].message = Some("it broke,\n\"badly\"".to_owned());
        let settings = results.scenario.settings().expect("legal");
        let text = String::from_utf8(write(&results.records, &settings).expect("written")).expect("UTF-8");
        assert_eq!(read(&text, &settings), Ok(results.records));
    }
}

//! The page of a search: the front, the confirmed settings, and what became of the others.

use super::document::{document, inline};
use super::drawing::percent;
use super::pareto_chart::{Cost, pareto_chart};
use super::search_lines::SearchLine;
use crate::sweep::Schedule;
use maud::{Markup, html};

/// What a search was, beside its lines.
#[derive(Debug, Clone, Copy)]
pub struct SearchFacts<'f> {
    /// Name of the preset.
    pub name: &'f str,
    /// Where and how its trials start: name of the row.
    pub row: &'f str,
    /// How its trials were shared out.
    pub schedule: &'f Schedule,
    /// How far below the best rate the chosen setting may lie, a fraction.
    pub within: f64,
    /// The preset as written.
    pub preset: &'f str,
    /// The command line.
    pub command: &'f str,
    /// Wall time of the search in seconds.
    pub wall_s: f64,
}

/// The report of a search.
#[must_use]
pub fn search_page(lines: &[SearchLine], facts: &SearchFacts<'_>) -> String {
    let title = format!("edgeloc optimise: {}", facts.name);
    let spent = lines.iter().map(|line| line.searched_trials + line.trials).sum::<u64>();
    let subtitle = format!("{} settings, {spent} trials, row {}", lines.len(), facts.row);
    let body = html! {
        section {
            h2 { "Success against time and map size" }
            p.note {
                "Confirmed settings only, on fresh robot poses, maps and noise that the search had not seen: bars are honest 95 % Wilson "
                "intervals. Blue: settings that no other beats in success, work and map at once; the line joins the best for "
                "their cost. Ringed: the preset. Time is work, a count that is alike on every machine, at the mean speed "
                "measured here; the table has each setting's own wall time."
            }
            div.panels {
                figure { (inline(&pareto_chart(lines, Cost::Time))) }
                figure { (inline(&pareto_chart(lines, Cost::MapSize))) }
            }
        }
        (confirmed(lines, facts))
        (others(lines, facts))
        section {
            h2 { "The preset" }
            pre { (facts.preset) }
        }
        section {
            h2 { "Facts" }
            dl {
                dt { "command" } dd { code { (facts.command) } }
                dt { "wall time" } dd { (format!("{:.0} s", facts.wall_s)) }
                dt { "trials" } dd { (spent) " of at most " (facts.schedule.trials_total) }
            }
        }
    };
    document(&title, &subtitle, &body)
}

fn confirmed(lines: &[SearchLine], facts: &SearchFacts<'_>) -> Markup {
    html! { section {
        h2 { "Confirmed settings" }
        p.note {
            "The preset is the setting of least work whose rate lies within " (format!("{:.1}", 100.0 * facts.within))
            " points of the best. Differences are from the origin, trial by trial (McNemar, Holm over these settings). "
            "Chosen among finalists by these very trials, it had luck as well as merit: its own rate is a little flattered, and a run "
            "of the preset with another seed tells it without."
        }
        div.wide { table {
            (header(lines))
            @for line in lines.iter().filter(|line| line.trials > 0) { tr {
                td { (line.setting) @if line.setting == 0 { " origin" } @if line.is_chosen { " chosen" } @if line.is_on_front { span.quiet { " front" } } }
                @for value in line.values.values() { td.number { (value) } }
                td { (percent(line.success_rate.unwrap_or(0.0))) (format!(" [{:.1},\u{a0}{:.1}]", 100.0 * line.success_rate_low, 100.0 * line.success_rate_high)) }
                td.number { (line.trials) }
                td.number { (format!("{:.2}", line.mean_looks)) }
                td.number { (format!("{:.1} ms", 1e3 * line.mean_localizer_s)) }
                td.number { (format!("{:.0} kB", line.map_bytes / 1e3)) }
                td.number { @if let (Some(difference), Some(low), Some(high)) = (line.difference, line.difference_low, line.difference_high) {
                    (format!("{:+.1} [{:+.1}, {:+.1}]", 100.0 * difference, 100.0 * low, 100.0 * high))
                } }
                td.number { @if let Some(p) = line.p_holm { (format!("{p:.3}")) } }
            } }
        } }
    } }
}

fn header(lines: &[SearchLine]) -> Markup {
    html! { tr {
        th { "setting" }
        @if let Some(line) = lines.first() { @for key in line.values.keys() { th.number { (axis(key)) } } }
        th { "success" } th.number { "trials" } th.number { "looks" } th.number { "time" } th.number { "map" } th.number { "points to origin" }
        th.number { "p, Holm" }
    } }
}

/// The last part of a key; it may be broken between its words, for there are many columns.
fn axis(key: &str) -> Markup {
    let mut words = key.rsplit('.').next().unwrap_or(key).split('_');
    html! { (words.next().unwrap_or_default()) @for word in words { "_" wbr; (word) } }
}

fn others(lines: &[SearchLine], facts: &SearchFacts<'_>) -> Markup {
    html! { section {
        h2 { "How the others left" }
        p.note {
            "After each of " (facts.schedule.rung_count()) " rungs the better half went on. \"Beaten\" is proven: evidence that "
            "may be read at any time, with 5 % of one false alarm among all pairs of settings. \"Not among the better half\" claims "
            "nothing: the trials were needed elsewhere. Rates of the rungs flatter those that they chose."
        }
        details { summary { "all settings" } div.wide { table {
            tr { th { "setting" } @if let Some(line) = lines.first() { @for key in line.values.keys() { th.number { (axis(key)) } } } th.number { "rate in rungs" } th.number { "trials" } th { "fate" } }
            @for line in lines { tr {
                td { (line.setting) }
                @for value in line.values.values() { td.number { (value) } }
                td.number { @if let Some(rate) = line.searched_rate { (percent(rate)) } }
                td.number { (line.searched_trials) }
                td { (line.fate) }
            } }
        } } }
    } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{search_csv, search_lines};
    use crate::scenario::Scenario;
    use crate::sweep::{Axis, Fate, Sample, Standing, TrialResult};

    fn sample(successes: usize, work: f64, map_bytes: f64) -> Sample {
        let trial = |index: usize| TrialResult { is_success: index < successes, looks: 2, work };
        Sample { trials: (0..100).map(trial).collect(), map_bytes, localizer_s: 2.0 }
    }

    #[test]
    fn the_page_is_self_contained_and_the_table_has_a_column_for_each_axis() {
        let axes = [Axis::parse("localizer.turn_deg=30,60").expect("an axis")];
        let points = [vec![], vec!["localizer.turn_deg=60".to_owned()], vec!["localizer.turn_deg=90".to_owned()]];
        let standing = |fate, confirmed| Standing { searched: sample(80, 5.0, 1e5), confirmed, fate };
        let standings = [
            standing(Fate::Finalist, Some(sample(90, 5.0, 1e5))),
            standing(Fate::Finalist, Some(sample(96, 4.0, 1e5))),
            standing(Fate::Beaten { rung: 0, by: 1 }, None),
        ];
        let lines = search_lines(&Scenario::default(), &axes, &points, &standings, 0.01).expect("legal points");
        assert_eq!((lines[0].values["localizer.turn_deg"].as_str(), lines[0].is_on_front), ("30.0", false));
        assert!(lines[1].is_chosen && lines[1].is_on_front && lines[1].p_holm.is_some_and(|p| p < 0.05));
        let csv = String::from_utf8(search_csv(&lines).expect("a table")).expect("UTF-8");
        assert!(csv.starts_with("setting,localizer.turn_deg,fate,searched_trials,"), "{csv}");
        assert!(csv.contains("\n2,90.0,beaten by setting 1 in rung 1,100,0.8,0,0,,"), "{csv}");

        let schedule = Schedule { settings: 3, finalists: 2, trials_total: 600 };
        let facts = SearchFacts {
            name: "quick",
            row: "near, polarity",
            schedule: &schedule,
            within: 0.01,
            preset: "name = \"quick\"",
            command: "edgeloc optimise",
            wall_s: 3.0,
        };
        let page = search_page(&lines, &facts);
        for part in ["chosen", "origin 90.0 %", "turn_<wbr>deg", "beaten by setting 1", "time of a localisation [ms]"] {
            assert!(page.contains(part), "the page lacks {part:?}");
        }
        // The name space of a drawing is a name, nothing that is fetched.
        let page = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for foreign in ["http", "<script", "src=", "NaN"] {
            assert!(!page.contains(foreign), "the page has {foreign:?}");
        }
    }
}

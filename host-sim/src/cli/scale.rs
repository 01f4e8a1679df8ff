//! `scale`: the localiser in maps of ever more nodes.

use super::console::{self, Format};
use super::progress;
use clap::Args;
use edgeloc::database::TopologicalDatabase;
use edgeloc::localize::{Localizer, LocalizerConfig};
use edgeloc_sim::map_file::MapFile;
use edgeloc_sim::monte_carlo::{Campus, CampusStart};
use edgeloc_sim::report::{ScaleFacts, ScaleLine, scale_chart, scale_csv, to_svg_file};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Buildings that robots are put down in: the same in every map, as far as it has them.
const BUILDINGS_OF_ROBOTS: u32 = 14;

/// Measure the default localiser in maps of ever more nodes: time of a look, memory, first stage and success.
///
/// A campus of generated offices is learned building by building, and mapped at each size. The same robots, with the same
/// looks, are put down anywhere in its first 14 buildings (a map of fewer has robots of its own), with the sources of the
/// scenario `edgeloc`. Times are of one thread. What was learned before is kept in the folder; measurements
/// start anew and take the place of earlier ones.
#[derive(Debug, Args)]
#[command(after_help = format!("Examples:\n  edgeloc scale --nodes 72,1000\n  edgeloc scale --nodes 72,1000,10000,100000 --trials 300\n  \
                        edgeloc scale --nodes 10000 --shortlist 100 --exact 10000\n\n\
                        Writes scale.csv and scale.svg, buildings/*.edgemap and a map for each size.\n\n\
                        JSON (--format json): a list of {JSON_FIELDS}."))]
pub(super) struct Scale {
    /// Sizes of the maps; each is rounded up to whole buildings.
    #[arg(long, value_delimiter = ',', value_name = "N", default_values_t = [72, 1000, 10_000],
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    nodes: Vec<u32>,
    /// Robots put down in each map.
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    trials: u32,
    /// Seed of the first office.
    #[arg(long, default_value_t = 1000, value_name = "SEED")]
    seed: u64,
    /// Nodes that are scored at a time [default: the localiser's].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    shortlist: Option<u16>,
    /// Also score every node at the first look, in maps of at most so many nodes.
    #[arg(long, value_name = "N", default_value_t = 0)]
    exact: u32,
    /// Folder for maps and results.
    #[arg(short, long, value_name = "FOLDER", default_value = "scale")]
    out: PathBuf,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The fields of a line, for the help.
const JSON_FIELDS: &str = "nodes, scored_nodes, trials, successes, success_rate_low, success_rate_high, wrong_answers, \
shortlisted_at_first, shortlisted_at_last, exact_trials, exact_right, exact_right_shortlisted, mean_looks, first_look_ms_min, \
first_look_ms_median, later_look_ms_median, first_stage_ms_min, first_stage_ms_median, position_error_m_median, map_bytes, \
memory_bytes, open_ms";

impl Scale {
    pub(super) fn execute(self) -> Result<()> {
        let campus = Campus::new(self.seed, &[]).into_diagnostic()?;
        let per_building = campus.nodes_per_building();
        let mut sizes: Vec<u32> = self.nodes.iter().map(|nodes| nodes.div_ceil(per_building)).collect();
        sizes.sort_unstable();
        sizes.dedup();
        std::fs::create_dir_all(&self.out)
            .into_diagnostic()
            .wrap_err_with(|| format!("the folder {} can't be made", self.out.display()))?;
        let mut lines = Vec::new();
        let mut starts: Option<(u32, Vec<CampusStart>)> = None;
        for buildings in sizes {
            let path = self.out.join(format!("campus-{}-{}.edgemap", self.seed, buildings * per_building));
            make_map(&campus, buildings, &self.out.join("buildings"), &path)?;
            let with_robots = buildings.min(BUILDINGS_OF_ROBOTS);
            if starts.as_ref().is_none_or(|(of, _)| *of != with_robots) {
                let bar = progress::bar(with_robots as usize, "buildings looked at");
                let drawn = campus.starts(with_robots, self.trials, &|| bar.step()).into_diagnostic()?;
                starts = Some((with_robots, drawn));
            }
            let starts = starts.as_ref().map_or(&[][..], |(_, starts)| starts);
            lines.push(self.measure(&path, starts)?);
            console::write_file(&self.out.join("scale.csv"), scale_csv(&lines).into_diagnostic()?.as_bytes())?;
            console::write_file(&self.out.join("scale.svg"), to_svg_file(scale_chart(&lines)).as_bytes())?;
        }
        match self.format {
            Format::Json => console::print_json(&lines),
            Format::Text => console::print(&table(&lines)),
        }
    }

    fn measure(&self, path: &Path, starts: &[CampusStart]) -> Result<ScaleLine> {
        let shortlist = self.shortlist.unwrap_or(LocalizerConfig::edgeloc().shortlist);
        let config = LocalizerConfig { shortlist, ..LocalizerConfig::edgeloc() };
        let file = MapFile::open(path).into_diagnostic()?;
        let opening = Instant::now();
        let map = TopologicalDatabase::open(&file).map_err(|error| miette!("{}: {error}", path.display()))?;
        let open = opening.elapsed();
        let mut memory = vec![0; Localizer::memory_len_in(&config, &map)];
        let bar = progress::bar(starts.len(), "robots");
        let mut records = Vec::new();
        for start in starts {
            records.push(start.run(map, &config, &mut memory).into_diagnostic()?);
            bar.step();
        }
        drop(bar);
        let is_asked = map.index().is_some() && map.node_count() <= self.exact as usize;
        let asked = if is_asked { starts } else { &[] };
        let bar = progress::bar(asked.len(), "exact scans");
        let keeps = |start: &CampusStart| {
            let kept = start.scan_exactly(map, &config);
            bar.step();
            kept
        };
        let exact = asked.par_iter().map(keeps).collect::<Result<Vec<_>, _>>().into_diagnostic()?;
        let facts = ScaleFacts {
            nodes: map.node_count() as u64,
            scored_nodes: map.index().map_or(map.node_count(), |_| map.node_count().min(usize::from(shortlist))) as u64,
            map_bytes: map.byte_len() as u64,
            memory_bytes: 8 * memory.len() as u64,
            open,
            first_stage: starts.iter().filter_map(|start| start.first_stage_time(&map)).collect(),
            exact: exact.into_iter().flatten().collect(),
        };
        Ok(ScaleLine::of(&facts, &records))
    }
}

/// Makes the map of the first `buildings` of a campus, with an index, unless it is there; the buildings' own maps are kept
/// in `folder`.
pub(super) fn make_map(campus: &Campus, buildings: u32, folder: &Path, path: &Path) -> Result<()> {
    if path.exists() {
        return Ok(());
    }
    std::fs::create_dir_all(folder)
        .into_diagnostic()
        .wrap_err_with(|| format!("the folder {} can't be made", folder.display()))?;
    let bar = progress::bar(buildings as usize, "buildings learned");
    campus.learn(folder, buildings, &|| bar.step()).into_diagnostic()?;
    drop(bar);
    let steps = campus.index_steps(buildings);
    let bar = progress::bar(steps, "views indexed");
    campus.map(folder, buildings, path, &|views| bar.steps(views)).into_diagnostic()
}

fn table(lines: &[ScaleLine]) -> String {
    let mut table = console::table(&[
        "nodes",
        "scored",
        "success [95 %]",
        "wrong",
        "looks",
        "first look, min / median",
        "later looks",
        "first stage",
        "truth shortlisted, first / last look",
        "exact scan right / of these shortlisted",
        "map, memory",
    ]);
    for line in lines {
        let ([first, last], [exact, kept]) = (line.shortlisted(), line.exact());
        let has_first_stage = line.scored_nodes < line.nodes;
        let of_first_stage = |what: String| if has_first_stage { what } else { "every node is scored".to_owned() };
        table.add_row([
            line.nodes.to_string(),
            line.scored_nodes.to_string(),
            line.success().to_string(),
            line.wrong_answers.to_string(),
            format!("{:.2}", line.mean_looks),
            format!("{:.1} / {:.1} ms", line.first_look_ms_min, line.first_look_ms_median),
            format!("{:.1} ms", line.later_look_ms_median),
            of_first_stage(format!("{:.2} / {:.2} ms", line.first_stage_ms_min, line.first_stage_ms_median)),
            of_first_stage(format!("{first} / {last}")),
            format!("{exact} / {kept}"),
            format!("{:.1} MB, {:.2} MB", line.map_bytes as f64 / 1e6, line.memory_bytes as f64 / 1e6),
        ]);
    }
    table.to_string()
}

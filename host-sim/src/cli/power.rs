//! `power`: how many trials separate two settings.

use super::console::{self, Format};
use clap::Args;
use edgeloc_sim::sweep::{Demand, independent_discordance};
use miette::{Result, miette};
use serde::Serialize;

/// The fields that `--format json` prints, for the help.
const JSON_FIELDS: &str = "\
rates (both, fractions of 1), difference, discordance (share of the trials in which exactly one of the two succeeds: given, \
or null), comparisons, significance, power, trials_paired_at_best (discordance as small as the difference allows), \
trials_paired (at the given discordance, or null), trials_paired_at_worst (settings that have nothing in common), \
trials_unpaired, detectable (null without --trials): trials, paired_loss and unpaired_loss, the least loss from the first \
rate that is found, null when none is";

/// Say how many trials separate two settings, before a run: at 95 % confidence and 80 % power.
///
/// Settings on the same robot poses and noise (two rows of a scenario, or two runs of one seed) are compared trial by
/// trial with McNemar's test; the less they disagree apart from their difference, the fewer trials are needed.
#[derive(Debug, Args)]
#[command(after_help = format!(
    "Examples:\n  edgeloc power 0.93 0.90\n  edgeloc power 0.93 0.90 --discordance 0.08\n  \
     edgeloc power 0.93 0.90 --trials 900 --comparisons 21\n\n\
     JSON (--format json): {JSON_FIELDS}."
))]
pub(super) struct Power {
    /// Success rate of the first setting, a fraction of 1.
    first: f64,
    /// Success rate of the second setting, a fraction of 1.
    second: f64,
    /// Share of the trials in which exactly one of the two succeeds, a fraction of 1; `edgeloc compare` and the table of
    /// `edgeloc figures` tell it of runs that are done.
    #[arg(long, value_name = "SHARE")]
    discordance: Option<f64>,
    /// Also say what so many trials of each setting detect.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    trials: Option<u64>,
    /// Comparisons that share the 5 % of one false alarm among all.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    comparisons: u32,
    /// How to print.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Serialize)]
struct Needed {
    rates: (f64, f64),
    difference: f64,
    discordance: Option<f64>,
    comparisons: u32,
    significance: f64,
    power: f64,
    trials_paired_at_best: u64,
    trials_paired: Option<u64>,
    trials_paired_at_worst: u64,
    trials_unpaired: u64,
    detectable: Option<Detectable>,
}

#[derive(Serialize)]
struct Detectable {
    trials: u64,
    paired_loss: Option<f64>,
    unpaired_loss: Option<f64>,
}

impl Power {
    pub(super) fn execute(self) -> Result<()> {
        let needed = self.needed()?;
        if self.format == Format::Json {
            return console::print_json(&needed);
        }
        let (first, second) = needed.rates;
        console::print(&format!(
            "to tell {} from {} with {:.2} % confidence and {:.0} % power, trials of each setting:",
            percent(first),
            percent(second),
            100.0 * (1.0 - needed.significance),
            100.0 * needed.power
        ))?;
        let mut table = console::table(&["trials compared", "disagreeing", "trials needed"]);
        let paired = "one by one, on the same poses and noise (McNemar)";
        let mut line = |how: &str, share: Option<f64>, trials: u64| {
            table.add_row([how.to_owned(), share.map_or_else(String::new, percent), trials.to_string()]);
        };
        line(paired, Some(needed.difference), needed.trials_paired_at_best);
        if let Some((share, trials)) = needed.discordance.zip(needed.trials_paired) {
            line(paired, Some(share), trials);
        }
        line(paired, Some(independent_discordance(needed.rates)), needed.trials_paired_at_worst);
        line("as two rates, each on trials of its own", None, needed.trials_unpaired);
        console::print(&table.to_string())?;
        let Some(Detectable { trials, paired_loss, unpaired_loss }) = needed.detectable else { return Ok(()) };
        let (trials, first) = (console::count(trials, "trial"), percent(first));
        if paired_loss.or(unpaired_loss).is_none() {
            return console::print(&format!("{trials} of each setting can't detect even a fall from {first} to 0"));
        }
        let loss = |loss: Option<f64>| {
            loss.map_or_else(|| "no loss".to_owned(), |loss| format!("a loss of {:.1} points", 100.0 * loss))
        };
        let (paired, unpaired) = (loss(paired_loss), loss(unpaired_loss));
        console::print(&format!(
            "{trials} of each setting detect, from {first}, {paired} one by one and {unpaired} as two rates"
        ))
    }

    fn needed(&self) -> Result<Needed> {
        let rates = (self.first, self.second);
        for rate in [Some(rates.0), Some(rates.1), self.discordance].into_iter().flatten() {
            if !(0.0..=1.0).contains(&rate) {
                return Err(miette!(help = "write 93 % as 0.93", "{rate} is no fraction of 1"));
            }
        }
        let difference = (rates.0 - rates.1).abs();
        if self.discordance.is_some_and(|share| share < difference) {
            let help = format!("rates that differ by {difference:.4} disagree in at least that share of the trials");
            return Err(miette!(help = help, "a discordance below the difference of the rates can't be"));
        }
        let demand = Demand::default().shared_by(self.comparisons as usize);
        let equal = || miette!(help = "give two different rates", "no number of trials separates equal rates");
        let pairs = |share: f64| demand.pairs_needed(rates, share).ok_or_else(equal);
        let detectable = self.trials.map(|trials| Detectable {
            trials,
            paired_loss: demand.detectable_loss(rates.0, self.discordance, trials),
            unpaired_loss: demand.detectable_unpaired_loss(rates.0, trials),
        });
        Ok(Needed {
            rates,
            difference,
            discordance: self.discordance,
            comparisons: self.comparisons,
            significance: demand.significance,
            power: demand.power,
            trials_paired_at_best: pairs(difference)?,
            trials_paired: self.discordance.map(pairs).transpose()?,
            trials_paired_at_worst: pairs(independent_discordance(rates))?,
            trials_unpaired: demand.unpaired_trials_needed(rates).ok_or_else(equal)?,
            detectable,
        })
    }
}

fn percent(rate: f64) -> String {
    format!("{:.1} %", 100.0 * rate)
}

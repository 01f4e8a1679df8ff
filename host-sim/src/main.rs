//! `edgeloc`: build worlds, learn them, localise a kidnapped robot in them many times, look at what came out.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}

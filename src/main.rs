//! The `slcbeam` program: everything it does is in the library.

fn main() -> std::process::ExitCode {
    slcbeam::cli::main()
}

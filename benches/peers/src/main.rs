//! Commands of scripts/bench, one per process; the library implements them.
//!
//! ```text
//! peers serve                         runs on requests, line by line: SCENE METHOD RTOL
//! peers export SCENE                  its parameters, for benches/python
//! peers prices SCENE                  seconds of a residual, a Jacobian, factors, a solution
//! peers profile SCENE METHOD RTOL     time of a run by operation, with work counters
//! peers work SCENE OPERATION COUNT    repeats an operation, for instruction counters
//! peers large WIRING PER_ROW          a beam of PER_ROW segments for 60 steps
//! ```

use std::collections::HashMap;
use std::io::Write;
use std::process::ExitCode;

use peers::scene::{Ran, Scene};
use peers::{chains, export, floor, other, own, prices, radau};

/// Runs a method; for Radau's method the seconds are modelled.
fn run(scene: &Scene, method: &str, rtol: f64) -> Result<Ran, String> {
    if method == "radau" {
        return Ok(radau::follow(scene, rtol));
    }
    match own::options(scene, method, rtol) {
        Some(options) => own::follow(scene, &options),
        None => other::follow(scene, method, rtol),
    }
}

/// Answers `SCENE METHOD RTOL` by `seconds steps tip.. pressure..`, or by `failed` and the reason.
fn serve() {
    let mut scenes: HashMap<String, Scene> = HashMap::new();
    for line in std::io::stdin().lines().map_while(Result::ok) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, method, rtol] = words[..] else { continue };
        let scene = scenes.entry(name.to_owned()).or_insert_with(|| Scene::named(name));
        let answer = match rtol.parse().map_err(|_| "no tolerance".to_owned()) {
            Ok(rtol) => run(scene, method, rtol),
            Err(words) => Err(words),
        };
        let text = match answer {
            Ok(ran) => {
                let numbers = (0..2).flat_map(|k| ran.readings.iter().map(move |both| both[k]));
                let numbers: Vec<String> = numbers.map(|x| format!("{x:e}")).collect();
                format!("{:e} {} {}", ran.seconds, ran.steps, numbers.join(" "))
            }
            Err(words) => format!("failed {}", words.replace('\n', " ")),
        };
        println!("{text}");
        let _ = std::io::stdout().flush();
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["serve"] => serve(),
        ["export", name] => println!("{}", export::scene(&Scene::named(name))),
        ["prices", name] => println!("{}", prices::table(&Scene::named(name))),
        ["profile", name, method, rtol] => {
            let scene = Scene::named(name);
            let profile = own::profile(&scene, method, rtol.parse().expect("a tolerance"));
            println!("{}", profile.expect("a run"));
        }
        ["work", name, what, count] => {
            let scene = Scene::named(name);
            prices::Bench::new(&scene).work(what, count.parse().expect("a number"));
        }
        ["large", wiring, per_row] => {
            let per_row = per_row.parse().expect("a number");
            println!("{}", floor::measure(chains::case(wiring, per_row)));
        }
        _ => {
            eprintln!(
                "peers serve | export SCENE | prices SCENE | profile SCENE METHOD RTOL | work SCENE OPERATION COUNT | large WIRING PER_ROW"
            );
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

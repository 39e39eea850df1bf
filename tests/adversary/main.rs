//! The adversary: random scenes, each run as a user would and judged against a reference that shares little with it.
//!
//! Score: silently wrong is what is off by more than was asked, or at default settings by more than 5 % of the figure, without
//! a warning that names it.
//!
//! ```text
//! cargo test --release --test adversary -- --nocapture
//! cargo test --release --test adversary -- --ignored --nocapture five_thousand
//! SLCBEAM_ADVERSARY=100 SLCBEAM_ADVERSARY_FIRST=7001 cargo test --release --test adversary -- --ignored --nocapture five_thousand
//! SLCBEAM_ADVERSARY_SEED=17 cargo test --release --test adversary -- --ignored --nocapture shrink_one
//! ```

#[path = "../common/chance.rs"]
mod chance;
mod coverage;
mod digits;
mod further;
mod graphs;
mod judge;
mod network;
mod parts;
mod profiles;
mod promise;
mod reference;
mod run;
mod scene;
mod shrink;
mod signals;
mod tally;
mod trust;

use judge::{Verdict, Word};
use scene::Kind;

/// Scenes of every test run.
const SCENES: u64 = 200;

fn none_silent(lines: &[serde_json::Value]) {
    let silent: Vec<String> = tally::silent(lines).into_iter().map(|(_, told)| told).collect();
    assert!(
        silent.is_empty(),
        "{} silently wrong:\n{}",
        silent.len(),
        silent.join("\n")
    );
}

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// Verdicts on so many scenes of a kind, or on `SLCBEAM_ADVERSARY`, from `SLCBEAM_ADVERSARY_FIRST` on; goes on where it ended.
fn chosen(kind: Kind, usual: u64) -> Vec<serde_json::Value> {
    let (count, first) = (number("SLCBEAM_ADVERSARY"), number("SLCBEAM_ADVERSARY_FIRST"));
    let lines = tally::run(kind, first.unwrap_or(1), count.unwrap_or(usual), true);
    println!("{}", tally::table(&lines));
    lines
}

/// Seeds among them that are silently wrong and known to be, and why: `docs/stability.md`, "What stays open".
const KNOWN: &[(u64, &str)] = &[];

/// Seeds beyond these that were silently wrong: half the cells agreed by accident (20159, 20272, 21102), mesh and tolerance of the companion
/// cancelled (20290), a load vanished on both meshes (254, 20792), quantities at rounding level were judged (20316, 20362, 20536).
const FORMERLY_SILENT: [u64; 9] = [254, 20159, 20272, 20290, 20316, 20362, 20536, 20792, 21102];

/// Goal: of 200 scenes none is silently wrong but those that are known to be, and these still are. Those that were silently wrong are right
/// or warned of.
#[test]
fn no_scene_is_silently_wrong() {
    let mut lines = tally::run(Kind::Extreme, 1, SCENES, false);
    let formerly = FORMERLY_SILENT.map(|seed| tally::run(Kind::Extreme, seed, 1, false));
    lines.extend(formerly.into_iter().flatten());
    println!("{}", tally::table(&lines));
    let known = |seed: &u64| KNOWN.iter().any(|(known, _)| known == seed);
    let silent = tally::silent(&lines);
    let new: Vec<&str> = silent
        .iter()
        .filter(|(s, _)| !known(s))
        .map(|(_, told)| told.as_str())
        .collect();
    assert!(new.is_empty(), "{} silently wrong:\n{}", new.len(), new.join("\n"));
    for (seed, cause) in KNOWN {
        assert!(
            silent.iter().any(|(s, _)| s == seed),
            "{seed} is right now, of which was known: {cause}"
        );
    }
}

/// The same of 5000 scenes, or of `SLCBEAM_ADVERSARY` from `SLCBEAM_ADVERSARY_FIRST`; goes on where it ended.
#[test]
#[ignore = "takes hours"]
fn no_scene_of_five_thousand_is_silently_wrong() {
    none_silent(&chosen(Kind::Extreme, 5000));
}

/// Goal: of 300 scenes with what is attached, around, relaxes, is curved at rest, shears or is compressed none is silently wrong.
#[test]
#[ignore = "takes minutes"]
fn no_scene_with_further_effects_is_silently_wrong() {
    none_silent(&chosen(Kind::Further, 300));
}

/// Goal: of 300 scenes with walls, check valves, pumps, vessels and syringes none is silently wrong.
#[test]
#[ignore = "takes minutes"]
fn no_scene_with_parts_is_silently_wrong() {
    none_silent(&chosen(Kind::Parts, 300));
}

/// Goal: of 300 graphs of beams none is silently wrong.
#[test]
#[ignore = "takes minutes"]
fn no_graph_of_beams_is_silently_wrong() {
    none_silent(&chosen(Kind::Graph, 300));
}

/// Goal: of 200 sane scenes at most 5 % carry a warning that the reference shows to be needless, and none is silently wrong.
#[test]
#[ignore = "takes a quarter of an hour"]
fn sane_scenes_are_rarely_warned_needlessly() {
    let lines = chosen(Kind::Sane, 200);
    let count = lines.len() as u64;
    let needless = lines.iter().filter(|line| !line["needless"].is_null()).count() as u64;
    assert!(20 * needless <= count, "{needless} of {count} warned needlessly");
    none_silent(&lines);
}

/// Goal: bars are at least a third of the errors above 1e-3 in 95 % and within a third and four times in 80 %, over 200 scenes, or over `SLCBEAM_ADVERSARY` from `SLCBEAM_ADVERSARY_FIRST`.
#[test]
#[ignore = "takes minutes"]
fn error_bars_cover_errors() {
    let (count, first) = (number("SLCBEAM_ADVERSARY"), number("SLCBEAM_ADVERSARY_FIRST"));
    let all = coverage::run(kind(), first.unwrap_or(1), count.unwrap_or(200));
    println!("{}", coverage::table(&all));
    let [covered, sharp] = coverage::shares(&all);
    assert!(covered >= 0.95 && sharp >= 0.8, "{covered} {sharp}");
}

/// Goal: of 100 scenes, or of `SLCBEAM_ADVERSARY` from `SLCBEAM_ADVERSARY_FIRST`, for which 1 % is asked, those that are said to reach it do, but for
/// one in a hundred.
#[test]
#[ignore = "takes minutes"]
fn accuracies_are_kept() {
    let (count, first) = (number("SLCBEAM_ADVERSARY"), number("SLCBEAM_ADVERSARY_FIRST"));
    let tally = promise::run(kind(), first.unwrap_or(1), count.unwrap_or(100));
    println!("{tally:?}");
    assert!(tally.broken.len() * 100 <= tally.reached, "{tally:?}");
}

/// Of which scenes a seed is: of those that `SLCBEAM_ADVERSARY_KIND` names, `sane`, `further`, `parts` or `graph`.
fn kind() -> Kind {
    match std::env::var("SLCBEAM_ADVERSARY_KIND").as_deref() {
        Ok("sane") => Kind::Sane,
        Ok("further") => Kind::Further,
        Ok("parts") => Kind::Parts,
        Ok("graph") => Kind::Graph,
        _ => Kind::Extreme,
    }
}

/// Writes the scene of `SLCBEAM_ADVERSARY_SEED` as a file that `slcbeam run` takes.
#[test]
#[ignore = "for a seed to be looked at"]
fn write_one() {
    let Some(seed) = number("SLCBEAM_ADVERSARY_SEED") else {
        return;
    };
    let kind = kind();
    let path = format!("{}/{}.json", tally::FOLDER, tally::name(kind, seed));
    std::fs::create_dir_all(tally::FOLDER).expect("a folder for what is found");
    tally::write(&path, &scene::draw(seed, kind));
    println!("{path}");
}

/// Makes the scene of `SLCBEAM_ADVERSARY_SEED` smaller, as long as it is silently wrong for the same cause.
#[test]
#[ignore = "for a seed that fails"]
fn shrink_one() {
    let Some(seed) = number("SLCBEAM_ADVERSARY_SEED") else {
        return;
    };
    let kind = kind();
    let tries = number("SLCBEAM_ADVERSARY_TRIES").unwrap_or(150) as usize;
    let scene = scene::draw(seed, kind);
    let close = tally::close(kind, tally::asked(seed), true);
    let both = judge::judge(&scene, tally::asked(seed), [true, true], close);
    println!(
        "{:?} {}\n{:?} {}",
        both.default.word, both.default.why, both.promise.word, both.promise.why
    );
    let alike = |old: &Verdict, new: &Verdict| {
        new.word == Word::Silent && (old.causes.is_empty() || old.causes.iter().any(|c| new.causes.contains(c)))
    };
    for (part, name) in [([true, false], "default"), ([false, true], "promise")] {
        let of = |both: &judge::Both| {
            if part[0] {
                both.default.clone()
            } else {
                both.promise.clone()
            }
        };
        let old = of(&both);
        if old.word != Word::Silent {
            continue;
        }
        let fails = |scene: &serde_json::Value| alike(&old, &of(&judge::judge(scene, both.asked, part, close)));
        let small = shrink::shrink(&scene, tries, fails);
        let path = format!("{}/{}-{name}-small.json", tally::FOLDER, tally::name(kind, seed));
        tally::write(&path, &small);
        println!(
            "{path}: {}\n{small:#}",
            of(&judge::judge(&small, both.asked, part, close)).why
        );
    }
}

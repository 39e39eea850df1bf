//! The adversary: random scenes, each run as a user would and judged against a reference that shares little with it.

mod judge;
mod network;
mod profiles;
mod promise;
mod random;
mod reference;
mod run;
mod scene;
mod signals;
mod trust;

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

#[test]
fn scenes() {
    let number = |name: &str, or: u64| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(or);
    let (count, first) = (number("SLCBEAM_ADVERSARY", 200), number("SLCBEAM_ADVERSARY_FIRST", 1));
    let kind = if std::env::var("SLCBEAM_ADVERSARY_SANE").is_ok() { scene::Kind::Sane } else { scene::Kind::Extreme };
    let next = AtomicUsize::new(0);
    let tally = Mutex::new(BTreeMap::<String, Vec<u64>>::new());
    std::fs::create_dir_all("target/adversary").expect("folder");
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let seed = first + next.fetch_add(1, Ordering::Relaxed) as u64;
                    if seed >= first + count {
                        break;
                    }
                    let scene = scene::draw(seed, kind);
                    if std::env::var("SLCBEAM_ADVERSARY_DRAW").is_ok() {
                        let text = serde_json::to_string_pretty(&scene).expect("JSON");
                        std::fs::write(format!("target/adversary/{seed}.json"), text).expect("write");
                        continue;
                    }
                    let begin = std::time::Instant::now();
                    let asked = if seed % 2 == 0 { 0.1 } else { 0.01 };
                    let both = judge::judge(&scene, asked, [true, true]);
                    println!(
                        "{seed} {:.2}s A {:?} {:?} {}\n{seed} B {asked} {:?} {}",
                        begin.elapsed().as_secs_f64(), both.default.word, both.default.needless, both.default.why,
                        both.promise.word, both.promise.why
                    );
                    if [both.default.word, both.promise.word].contains(&judge::Word::Silent) {
                        let text = serde_json::to_string_pretty(&scene).expect("JSON");
                        std::fs::write(format!("target/adversary/{seed}.json"), text).expect("write");
                    }
                    let mut tally = tally.lock().expect("lock");
                    tally.entry(format!("A {:?}", both.default.word)).or_default().push(seed);
                    tally.entry(format!("B {:?}", both.promise.word)).or_default().push(seed);
                    if both.default.needless.is_some() {
                        tally.entry("needless".into()).or_default().push(seed);
                    }
                }
            });
        }
    });
    for (word, seeds) in tally.into_inner().expect("lock") {
        println!("{word}: {} {seeds:?}", seeds.len());
    }
}

//! The mesh that a search begins with: on half of it, too, everything that is given along the beam is to be seen.

use crate::case::{Case, Profile};

/// Cells a segment to begin with where nothing asks for more.
const LEAST: usize = 2;
/// And where much does.
const MOST: usize = 32;
/// Part of the area under a profile that straight lines between nodes may miss.
const MISSED: f64 = 0.2;
/// Places at which a profile is looked at, at least, and at most.
const PLACES: [usize; 2] = [1000, 40_000];

/// Fewest cells a segment, a power of two, half of which see every load and every shape at the start: two meshes that both miss
/// one agree about it.
pub fn least_cells(case: &Case) -> usize {
    let loads = case
        .loads
        .iter()
        .filter_map(|load| Some(&load.distributed()?.1.profile));
    let start = &case.start;
    let start = [&start.u1_m, &start.u3_m, &start.u1_rate_m_s, &start.u3_rate_m_s];
    let profiles: Vec<&Profile> = loads.chain(start.into_iter().flatten()).collect();
    let sees = |cells: usize| profiles.iter().all(|p| missed(p, case.segments() * cells) <= MISSED);
    let mut cells = LEAST;
    while cells < MOST && !sees(cells / 2) {
        cells *= 2;
    }
    cells
}

/// Area between a profile and straight lines through its values at the ends of so many cells, over the area under it.
fn missed(profile: &Profile, cells: usize) -> f64 {
    let places = (4.0 / narrowest(profile)).clamp(PLACES[0] as f64, PLACES[1] as f64);
    let within = (places / cells as f64).ceil() as usize;
    let (mut all, mut missed) = (0.0, 0.0);
    let node = |k: usize| profile.value(k as f64 / cells as f64);
    let mut left = node(0);
    for k in 0..cells {
        let right = node(k + 1);
        for part in 0..within {
            let share = (part as f64 + 0.5) / within as f64;
            let value = profile.value((k as f64 + share) / cells as f64);
            all += value.abs();
            missed += (value - left - share * (right - left)).abs();
        }
        left = right;
    }
    if missed > 0.0 { missed / all } else { 0.0 }
}

/// Length, over the beam's, of the narrowest thing in a profile.
fn narrowest(profile: &Profile) -> f64 {
    let least = |all: &[Profile]| all.iter().map(narrowest).fold(1.0, f64::min);
    match profile {
        Profile::Constant(_) | Profile::Polynomial(_) => 1.0,
        Profile::Cosine(wave) | Profile::Sine(wave) => 0.25 / wave.waves.abs().max(0.25),
        Profile::Table(table) => {
            let apart = table.positions.windows(2).map(|pair| pair[1] - pair[0]);
            apart.filter(|apart| *apart > 0.0).fold(1.0, f64::min)
        }
        Profile::Sum(all) | Profile::Product(all) => least(all),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: profiles that nodes miss are missed in part or whole, those that they see are not, however finely they are given.
    #[test]
    fn what_nodes_miss_is_noticed() {
        let profile = |text: &str| -> Profile {
            match serde_json::from_str(text) {
                Ok(profile) => profile,
                Err(error) => panic!("{error}"),
            }
        };
        let pad = profile(
            r#"{"table": {"positions": [0, 0.524, 0.525, 0.535, 0.536, 1], "values": [0, 0, 1, 1, 0, 0],
            "interpolation": "linear"}}"#,
        );
        assert!(missed(&pad, 10) > 0.9 && missed(&pad, 20) > 0.9, "a pad between nodes");
        assert!(missed(&pad, 1000) < 0.1, "{}", missed(&pad, 1000));
        let waves = profile(r#"{"cosine": {"waves": 20}}"#);
        assert!(
            missed(&waves, 10) > 0.9 && missed(&waves, 20) > 0.9,
            "waves that look uniform"
        );
        assert!(missed(&waves, 160) < MISSED);
        assert!(missed(&profile(r#"{"cosine": {"waves": 1}}"#), 10) < MISSED);
        assert_eq!(missed(&profile("3"), 1), 0.0);
        let points: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
        let fine = serde_json::json!({"table": {"positions": points, "values": points, "interpolation": "linear"}});
        assert!(missed(&profile(&fine.to_string()), 10) < 1e-12);
    }
}

//! The rules a section must keep, all at once.

use super::outline::{Outline, distance, inside, signed_area};
use crate::error::Fault;
use crate::input::{Bladder, Material, Point, RegionShape, Row, Section, Shape};

/// A wall must be thicker than this part of the smallest outer size: thinner ones are zero for a mesh of single triangles across.
const THINNEST: f64 = 1e-3;

struct Rules {
    faults: Vec<Fault>,
}

impl Rules {
    fn fault(&mut self, place: impl Into<String>, what: impl Into<String>) {
        self.faults.push(Fault {
            place: place.into(),
            what: what.into(),
        });
    }

    fn positive(&mut self, place: String, value: f64) -> bool {
        let good = value.is_finite() && value > 0.0;
        if !good {
            self.fault(place, format!("must be a finite number above 0, is {value}"));
        }
        good
    }

    fn finite(&mut self, place: String, values: &[f64]) -> bool {
        let good = values.iter().all(|v| v.is_finite());
        if !good {
            self.fault(place, "must be finite");
        }
        good
    }

    fn material(&mut self, place: &str, material: &Material) {
        self.positive(format!("{place}/young_modulus_pa"), material.young_modulus_pa);
        self.positive(format!("{place}/density_kg_m3"), material.density_kg_m3);
        let nu = material.poisson_ratio;
        if !(nu > -1.0 && nu < 0.5) {
            let hint = if nu >= 0.5 {
                "; an incompressible material is well served by 0.4999"
            } else {
                ""
            };
            self.fault(
                format!("{place}/poisson_ratio"),
                format!("must lie above -1 and below 0.5, is {nu}{hint}"),
            );
        }
    }

    fn polygon(&mut self, place: &str, points: &[Point]) -> bool {
        if points.len() < 3 {
            self.fault(place, "a polygon needs three corners at least");
            return false;
        }
        if !self.finite(place.to_owned(), points.as_flattened()) {
            return false;
        }
        if let Some((i, j)) = crossing(points) {
            self.fault(
                place,
                format!("the sides from corner {i} and from corner {j} cross or touch"),
            );
            return false;
        }
        let extent = points
            .iter()
            .flat_map(|p| points.iter().map(move |q| (p[0] - q[0]).hypot(p[1] - q[1])))
            .fold(0.0, f64::max);
        if signed_area(points).abs() < 1e-9 * extent * extent {
            self.fault(place, "the polygon has no area");
            return false;
        }
        true
    }

    fn shape(&mut self, place: &str, shape: &Shape) -> bool {
        match shape {
            Shape::Circle { radius_m } => self.positive(format!("{place}/circle/radius_m"), *radius_m),
            Shape::Ellipse { along_m, high_m } => {
                let along = self.positive(format!("{place}/ellipse/along_m"), *along_m);
                self.positive(format!("{place}/ellipse/high_m"), *high_m) && along
            }
            Shape::RoundedRectangle {
                along_m,
                high_m,
                fillet_m,
            } => {
                let along = self.positive(format!("{place}/rounded_rectangle/along_m"), *along_m);
                let sizes = self.positive(format!("{place}/rounded_rectangle/high_m"), *high_m) && along;
                let most = along_m.min(*high_m) / 2.0;
                let fillet = (0.0..=most * (1.0 + 1e-9)).contains(fillet_m);
                if sizes && !fillet {
                    let what = format!("must lie between 0 and half of the shorter side, {most} m, is {fillet_m}");
                    self.fault(format!("{place}/rounded_rectangle/fillet_m"), what);
                }
                sizes && fillet
            }
            Shape::Polygon { points_m } => self.polygon(&format!("{place}/polygon/points_m"), points_m),
        }
    }

    fn bladder(&mut self, place: &str, bladder: &Bladder) -> Option<Outline> {
        let center = self.finite(format!("{place}/center_m"), &[bladder.center_m]);
        (self.shape(&format!("{place}/shape"), &bladder.shape) && center).then(|| Outline::bladder(bladder))
    }

    fn region(&mut self, place: &str, shape: &RegionShape, pitch: f64) -> Option<Outline> {
        let ordered = |r: &[f64; 2]| r[0].is_finite() && r[1].is_finite() && r[0] < r[1];
        let mut range = |name: &str, r: &[f64; 2]| {
            if !ordered(r) {
                self.fault(
                    format!("{place}/{name}"),
                    format!("must go from a smaller to a larger number, is {r:?}"),
                );
            }
            ordered(r)
        };
        let good = match shape {
            RegionShape::Layer { high_m } => range("layer/high_m", high_m),
            RegionShape::Rectangle { along_m, high_m } => {
                let along = range("rectangle/along_m", along_m);
                range("rectangle/high_m", high_m) && along
            }
            RegionShape::Circle { center_m, radius_m } => {
                let center = self.finite(format!("{place}/circle/center_m"), center_m);
                self.positive(format!("{place}/circle/radius_m"), *radius_m) && center
            }
            RegionShape::Polygon { points_m } => self.polygon(&format!("{place}/polygon/points_m"), points_m),
        };
        good.then(|| Outline::region(shape, pitch))
    }
}

/// Every rule the section breaks, in the order of its keys.
pub fn check(section: &Section) -> Vec<Fault> {
    let mut rules = Rules { faults: Vec::new() };
    let sizes = [
        ("/height_m", section.height_m),
        ("/width_m", section.width_m),
        ("/pitch_m", section.pitch_m),
    ];
    let mut good = true;
    for (place, value) in sizes {
        good &= rules.positive(place.to_owned(), value);
    }
    rules.material("/material", &section.material);
    let length = section.bladders.length_m;
    if rules.positive("/bladders/length_m".to_owned(), length) && length > section.width_m {
        let what = format!(
            "the bladders are longer, {length} m, than the beam is wide, {} m",
            section.width_m
        );
        rules.fault("/bladders/length_m", what);
    }
    let mut rows = Vec::new();
    match &section.bladders.upper {
        Row::Bladder(bladder) => rows.extend(
            rules
                .bladder("/bladders/upper", bladder)
                .map(|o| ("/bladders/upper".to_owned(), o)),
        ),
        Row::Mirrored => rules.fault("/bladders/upper", "only the lower row can be mirrored"),
        Row::None => {}
    }
    match &section.bladders.lower {
        Row::Bladder(bladder) => rows.extend(
            rules
                .bladder("/bladders/lower", bladder)
                .map(|o| ("/bladders/lower".to_owned(), o)),
        ),
        Row::Mirrored => {
            if let Some((_, upper)) = rows.first() {
                rows.push(("/bladders/lower".to_owned(), upper.mirrored()));
            }
        }
        Row::None => {}
    }
    let mut regions = Vec::new();
    for (k, region) in section.regions.iter().enumerate() {
        rules.material(&format!("/regions/{k}/material"), &region.material);
        let place = format!("/regions/{k}/shape");
        regions.extend(rules.region(&place, &region.shape, section.pitch_m).map(|o| (place, o)));
    }
    if good {
        room(&mut rules, section, &rows, &regions);
    }
    rules.faults
}

/// What lies outside, touches or overlaps.
fn room(rules: &mut Rules, section: &Section, rows: &[(String, Outline)], regions: &[(String, Outline)]) {
    let half = [section.pitch_m / 2.0, section.height_m / 2.0];
    let least = THINNEST * section.pitch_m.min(section.height_m);
    for (place, outline) in rows {
        let most = |k: usize| outline.chords().iter().fold(0.0_f64, |m, p| m.max(p[k].abs()));
        if half[0] - most(0) < least {
            let what = format!(
                "reaches {} m along the beam, its neighbour begins at half the pitch, {} m",
                most(0),
                half[0]
            );
            rules.fault(place, what);
        }
        if half[1] - most(1) < least {
            rules.fault(
                place,
                format!(
                    "reaches {} m from the mid-plane, the beam's surface lies at {} m",
                    most(1),
                    half[1]
                ),
            );
        }
    }
    if let [(_, upper), (place, lower)] = rows {
        match meeting(upper, lower) {
            gap if gap >= least => {}
            gap if gap > 0.0 => rules.fault(
                place,
                format!("the wall to the upper bladder is {gap} m thick, less than {least} m"),
            ),
            _ => rules.fault(place, "overlaps the upper bladder"),
        }
    }
    for (k, (place, outline)) in regions.iter().enumerate() {
        let outside = outline
            .chords()
            .iter()
            .any(|p| (0..2).any(|c| p[c].abs() > half[c] * (1.0 + 1e-9)));
        if outside {
            rules.fault(
                place,
                format!(
                    "reaches beyond the cell of {} m by {} m",
                    section.pitch_m, section.height_m
                ),
            );
        }
        for (other, row) in rows {
            if meeting_lines(outline, row) < least {
                rules.fault(place, format!("crosses or touches the bladder at {other}"));
            }
        }
        for (other, before) in &regions[..k] {
            if overlap(outline, before, 1e-6 * half[0].min(half[1])) {
                rules.fault(place, format!("overlaps the region at {other}"));
            }
        }
    }
}

/// The first two sides of a polygon that meet where they should not.
fn crossing(points: &[Point]) -> Option<(usize, usize)> {
    let n = points.len();
    let side = |i: usize| (points[i], points[(i + 1) % n]);
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.into_iter().find(|&(i, j)| {
        let ((a, b), (c, d)) = (side(i), side(j));
        if a == b || c == d {
            return true;
        }
        let neighbours = j == i + 1 || (i == 0 && j == n - 1);
        if neighbours {
            // Neighbours share a corner; they fault when one folds back on the other.
            let (shared, p, q) = if j == i + 1 { (b, a, d) } else { (a, b, c) };
            let (u, v) = (
                [p[0] - shared[0], p[1] - shared[1]],
                [q[0] - shared[0], q[1] - shared[1]],
            );
            let (cross, along) = (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
            return along > 0.0 && cross.abs() < 1e-9 * along;
        }
        cross(a, b, c, d)
            || [
                distance(a, c, d),
                distance(b, c, d),
                distance(c, a, b),
                distance(d, a, b),
            ]
            .contains(&0.0)
    })
}

/// Whether two segments cross in their interiors.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let turn = |p: Point, q: Point, r: Point| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

fn sides(points: &[Point]) -> impl Iterator<Item = (Point, Point)> + Clone {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

/// Distance between two outlines' lines, 0 when they cross.
fn meeting_lines(a: &Outline, b: &Outline) -> f64 {
    let (a, b) = (a.chords(), b.chords());
    let mut least = f64::MAX;
    for (p, q) in sides(&a) {
        for (r, s) in sides(&b) {
            if cross(p, q, r, s) {
                return 0.0;
            }
            least = least
                .min(distance(p, r, s))
                .min(distance(q, r, s))
                .min(distance(r, p, q))
                .min(distance(s, p, q));
        }
    }
    least
}

/// Distance between two outlines, 0 when they cross or one lies in the other.
fn meeting(a: &Outline, b: &Outline) -> f64 {
    let (pa, pb) = (a.chords(), b.chords());
    if inside(&pa, pb[0]) || inside(&pb, pa[0]) {
        0.0
    } else {
        meeting_lines(a, b)
    }
}

/// Whether two regions share more than a border.
fn overlap(a: &Outline, b: &Outline, slack: f64) -> bool {
    let (pa, pb) = (a.chords(), b.chords());
    let deep = |p: Point, of: &[Point]| inside(of, p) && sides(of).all(|(q, r)| distance(p, q, r) > slack);
    let probes = |points: &[Point]| -> Vec<Point> {
        let middles = sides(points).map(|(p, q)| [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0]);
        points.iter().copied().chain(middles).chain([within(points)]).collect()
    };
    let crossed = sides(&pa).any(|(p, q)| {
        sides(&pb).any(|(r, s)| {
            let near = [
                distance(p, r, s),
                distance(q, r, s),
                distance(r, p, q),
                distance(s, p, q),
            ]
            .into_iter()
            .fold(f64::MAX, f64::min);
            cross(p, q, r, s) && near > slack
        })
    });
    crossed || probes(&pa).into_iter().any(|p| deep(p, &pb)) || probes(&pb).into_iter().any(|p| deep(p, &pa))
}

/// A point inside a polygon: the middle of the longest stretch inside on the level line through its middle height.
fn within(points: &[Point]) -> Point {
    let mut heights: Vec<f64> = points.iter().map(|p| p[1]).collect();
    heights.sort_by(f64::total_cmp);
    // Between two distinct heights: no corner lies on the line.
    let gap = heights
        .windows(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let x = gap.map_or(0.0, |g| (g[0] + g[1]) / 2.0);
    let hits = sides(points).filter(|(a, b)| (a[1] > x) != (b[1] > x));
    let mut at: Vec<f64> = hits
        .map(|(a, b)| a[0] + (x - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        .collect();
    at.sort_by(f64::total_cmp);
    [at.chunks_exact(2).map(|c| (c[0] + c[1]) / 2.0).next().unwrap_or(0.0), x]
}

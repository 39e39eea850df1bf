//! Distribution of static loads to the ends of a beam.

/// `M` or `N` over part of a cell: at both ends, and the mean.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Part {
    pub a: f64,
    pub b: f64,
    /// Index of the cell.
    pub cell: usize,
    pub from: f64,
    pub mean: f64,
    pub to: f64,
}

impl Part {
    pub fn integral(&self) -> f64 {
        (self.b - self.a) * self.mean
    }

    /// `∫ M²` of the parabola through both end values with the given mean.
    pub fn square(&self) -> f64 {
        let middle = self.middle();
        let ends = 2.0 * (self.from * self.from + self.to * self.to) - self.from * self.to;
        (self.b - self.a) / 15.0 * (ends + 2.0 * middle * (4.0 * middle + self.from + self.to))
    }

    fn middle(&self) -> f64 {
        0.25 * (6.0 * self.mean - self.from - self.to)
    }

    /// `∫ M f` by Simpson's rule.
    fn times(&self, f: &Function) -> f64 {
        let (a, m, b) = (self.a, 0.5 * (self.a + self.b), self.b);
        (b - a) / 6.0 * (self.from * f.value(a) + 4.0 * self.middle() * f.value(m) + self.to * f.value(b))
    }
}

/// Functions that may be added to the moments of a cantilever held at the root, for length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    /// A moment at the tip, or a normal force.
    Constant,
    /// A force at the tip.
    Line,
    /// Inertia of a beam in transverse motion.
    Moving,
    /// Inertia of a beam that rotates about its root.
    TurningAboutRoot,
    /// Inertia of a beam that rotates about its tip.
    TurningAboutTip,
    /// Inertia of a beam in axial motion.
    Along,
}

impl Function {
    /// `M`, with `M'' = 1, x, 1 - x` for transverse motions.
    fn value(self, x: f64) -> f64 {
        let y = 1.0 - x;
        match self {
            Self::Constant => 1.0,
            Self::Line => x,
            Self::Moving => 0.5 * y * y,
            Self::TurningAboutRoot => 0.5 * y * y - y * y * y / 6.0,
            Self::TurningAboutTip => y * y * y / 6.0,
            Self::Along => y,
        }
    }

    /// `-M'`.
    fn shear(self, x: f64) -> f64 {
        let y = 1.0 - x;
        match self {
            Self::Constant => 0.0,
            Self::Line => -1.0,
            Self::Moving => y,
            Self::TurningAboutRoot => y - 0.5 * y * y,
            Self::TurningAboutTip => 0.5 * y * y,
            Self::Along => 1.0,
        }
    }
}

/// Adds the effect of the end conditions to the moments (or normal forces) of a cantilever held at the root. Force and moment are zero
/// where an end is not held. The beam accelerates as a rigid body if nothing holds it. The remaining unknowns minimize `∫ M²`
/// (Castigliano).
pub(super) fn hold(held: &[[bool; 3]; 2], bends: bool, shear: f64, parts: &mut [Part]) {
    let (Some(first), Some(last)) = (parts.first(), parts.last()) else {
        return;
    };
    let (at_root, at_tip) = (first.from, last.to);
    let [root, tip] = held;
    let (functions, conditions) = if bends {
        let mut functions = vec![Function::Constant, Function::Line];
        if !root[0] && !tip[0] {
            functions.push(Function::Moving);
        }
        let hinged = !(root[1] || tip[1]);
        if hinged && !(root[0] && tip[0]) {
            functions.push(if tip[0] {
                Function::TurningAboutTip
            } else {
                Function::TurningAboutRoot
            });
        }
        let conditions = [
            (!root[1], 0.0, false, at_root),
            (!tip[1], 1.0, false, at_tip),
            (!root[0], 0.0, true, shear),
            (!tip[0], 1.0, true, 0.0),
        ];
        (functions, conditions)
    } else {
        let mut functions = vec![Function::Constant];
        if !root[2] && !tip[2] {
            functions.push(Function::Along);
        }
        let conditions = [
            (!root[2], 0.0, false, at_root),
            (!tip[2], 1.0, false, at_tip),
            (false, 0.0, false, 0.0),
            (false, 0.0, false, 0.0),
        ];
        (functions, conditions)
    };
    let conditions: Vec<_> = conditions.into_iter().filter(|c| c.0).collect();
    let n = functions.len();
    let mut rows = vec![vec![0.0; n + conditions.len() + 1]; n + conditions.len()];
    let right = n + conditions.len();
    for (i, f) in functions.iter().enumerate() {
        for part in parts.iter() {
            let (a, m, b) = (part.a, 0.5 * (part.a + part.b), part.b);
            let of = Part {
                a,
                b,
                cell: 0,
                from: f.value(a),
                mean: (f.value(a) + 4.0 * f.value(m) + f.value(b)) / 6.0,
                to: f.value(b),
            };
            for (j, g) in functions.iter().enumerate() {
                rows[i][j] += of.times(g);
            }
            rows[i][right] -= part.times(f);
        }
        for (k, &(_, x, shears, _)) in conditions.iter().enumerate() {
            let value = if shears { f.shear(x) } else { f.value(x) };
            rows[i][n + k] = value;
            rows[n + k][i] = value;
        }
    }
    for (k, &(_, _, _, value)) in conditions.iter().enumerate() {
        rows[n + k][right] = -value;
    }
    let shares = solved(rows);
    for part in parts {
        let (a, m, b) = (part.a, 0.5 * (part.a + part.b), part.b);
        for (f, share) in functions.iter().zip(&shares) {
            part.from += share * f.value(a);
            part.mean += share * (f.value(a) + 4.0 * f.value(m) + f.value(b)) / 6.0;
            part.to += share * f.value(b);
        }
    }
}

/// Solves a small linear system with the right-hand side last in each row; undetermined unknowns are 0.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    let mut pivots = vec![];
    let mut top = 0;
    for column in 0..n {
        let size = |row: &Vec<f64>| row[column].abs();
        let Some(best) = (top..n).max_by(|&i, &j| size(&rows[i]).total_cmp(&size(&rows[j]))) else {
            break;
        };
        if size(&rows[best]) < 1e-12 {
            continue;
        }
        rows.swap(top, best);
        let pivot = rows[top].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != top {
                let factor = row[column] / pivot[column];
                row.iter_mut().zip(&pivot).for_each(|(value, p)| *value -= factor * p);
            }
        }
        pivots.push(column);
        top += 1;
    }
    let mut solution = vec![0.0; n];
    for (row, &column) in rows.iter().zip(&pivots) {
        solution[column] = row[n] / row[column];
    }
    solution
}

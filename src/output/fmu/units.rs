//! Units of variables as products of SI base units.

/// Exponents of kg, m, s, K and rad.
type Exponents = [i32; 5];

/// Names of the base units, in the order of the exponents.
pub const BASE: [&str; 5] = ["kg", "m", "s", "K", "rad"];

/// Units from which those of variables are composed.
const SYMBOLS: [(&str, Exponents); 10] = [
    ("kg", [1, 0, 0, 0, 0]),
    ("m", [0, 1, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0]),
    ("°C", [0, 0, 0, 1, 0]),
    ("rad", [0, 0, 0, 0, 1]),
    ("N", [1, 1, -2, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0]),
    ("J", [1, 2, -2, 0, 0]),
    ("W", [1, 2, -3, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0]),
];

/// Exponents of a unit in the form of result columns: `N m`, `m^3/(s Pa)`, `1/m`; none if a symbol is unknown.
pub fn exponents(unit: &str) -> Option<Exponents> {
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    let mut all = [0; 5];
    for (part, sign) in [(above, 1), (below.trim_matches(['(', ')']), -1)] {
        for symbol in part.split_whitespace().filter(|symbol| *symbol != "1") {
            let (name, power) = symbol.split_once('^').unwrap_or((symbol, "1"));
            let (_, own) = SYMBOLS.iter().find(|(known, _)| *known == name)?;
            let power: i32 = power.parse().ok()?;
            all.iter_mut()
                .zip(own)
                .for_each(|(sum, own)| *sum += sign * power * own);
        }
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::exponents;
    use crate::case::readable::pointer_unit;

    /// Goal: derived units are products of base units, checked by hand.
    #[test]
    fn units_are_products_of_base_units() {
        assert_eq!(exponents("1"), Some([0; 5]));
        assert_eq!(exponents("1/m"), Some([0, -1, 0, 0, 0]));
        assert_eq!(exponents("m^3/s"), Some([0, 3, -1, 0, 0]));
        assert_eq!(exponents("N m s/rad"), Some([1, 2, -1, 0, -1]));
        assert_eq!(exponents("m^3/(s Pa)"), Some([-1, 4, 1, 0, 0]));
        assert_eq!(exponents("N/m"), exponents("J/m^2"));
        assert_eq!(exponents("W"), exponents("N m/s"));
        assert_eq!(exponents("lbf"), None);
        assert!(exponents(pointer_unit("/network/chains/0/ends/0/pressure_pa")).is_some());
    }
}

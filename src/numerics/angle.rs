//! Angle of a vector, without branches and calls, so that loops over vectors stay in registers.

/// π/4 as a double, whose small multiples are exact, and its rounding error.
const EIGHTH: [f64; 2] = [std::f64::consts::FRAC_PI_4, 3.061_616_997_868_383e-17];

/// Coefficients of `(atan z - z)/z³` in powers of z² up to 1/4, by interpolation at Chebyshev points; error 8e-19 of
/// the angle.
const SERIES: [f64; 13] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_994_88,
    -0.142_857_142_855_991_88,
    0.111_111_111_009_173_76,
    -0.090_909_086_203_225_23,
    0.076_922_947_125_402_85,
    -0.066_664_356_772_359_48,
    0.058_795_784_295_824_25,
    -0.052_400_995_079_947_13,
    0.046_280_248_685_701_53,
    -0.038_066_536_720_573_66,
    0.025_006_503_566_489_507,
    -0.009_215_792_047_089_858,
];

/// Angle of the vector `(x, y)` in `[-π, π]`; signed zeros as in C. The error for finite numbers is at most 2 units in
/// the last place, if the angle is not subnormal and `|x| + |y|` does not overflow.
#[inline(always)]
pub fn atan2(y: f64, x: f64) -> f64 {
    let (along, across) = (x.abs(), y.abs());
    let steep = across > along;
    let (small, large) = if steep { (along, across) } else { (across, along) };
    // tan(β - π/4) = (tan β - 1)/(tan β + 1); the numerator is exact here
    let turned = small > 0.5 * large;
    let (over, under) = if turned {
        (small - large, small + large)
    } else {
        (small, large)
    };
    let z = if small + large == 0.0 { 0.0 } else { over / under };
    let s = z * z;
    let c = &SERIES;
    let (s2, s4) = (s * s, (s * s) * (s * s));
    let low = (c[0] + s * c[1]) + s2 * (c[2] + s * c[3]);
    let middle = (c[4] + s * c[5]) + s2 * (c[6] + s * c[7]);
    let high = (c[8] + s * c[9]) + s2 * (c[10] + s * c[11]) + s4 * c[12];
    let beyond = z * s * (low + s4 * (middle + s4 * high));
    let mut eighths = if turned { 1.0 } else { 0.0 };
    let mut sense = 1.0;
    if steep {
        (eighths, sense) = (2.0 - eighths, -1.0);
    }
    if x.is_sign_negative() {
        (eighths, sense) = (4.0 - eighths, -sense);
    }
    let angle = eighths * EIGHTH[0] + (sense * z + (sense * beyond + eighths * EIGHTH[1]));
    angle.copysign(y)
}

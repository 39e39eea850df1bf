//! Our own operations for SUNDIALS' serial vectors.
//!
//! Clones inherit the table of operations, so all vectors that an integrator creates use it too. The table replaces the
//! functions that IDA and KINSOL call while they iterate; SUNDIALS' vector-array operations use loops over these.
//! SUNDIALS may pass one vector for several arguments: the data pointers are either equal, or the data are disjoint.
//! Each operation distinguishes these cases before it creates slices.

use std::ffi::c_int;
use std::slice;

use sundials_sys::{_generic_N_Vector_Ops, N_VClone_Serial, N_Vector};

use super::vector::{entries, entries_mut, parts};
use crate::numerics::kernels;

/// Enters our operations into the table of a serial vector.
pub(super) fn replace(ops: &mut _generic_N_Vector_Ops) {
    ops.nvclone = Some(clone);
    ops.nvlinearsum = Some(linear_sum);
    ops.nvlinearcombination = Some(linear_combination);
    ops.nvconst = Some(fill);
    ops.nvprod = Some(product);
    ops.nvdiv = Some(quotient);
    ops.nvscale = Some(scale);
    ops.nvabs = Some(abs);
    ops.nvinv = Some(inverse);
    ops.nvaddconst = Some(add_constant);
    ops.nvdotprod = Some(dot);
    ops.nvmaxnorm = Some(max_norm);
    ops.nvmin = Some(min);
    ops.nvl1norm = Some(l1_norm);
    ops.nvwl2norm = Some(weighted_l2_norm);
    ops.nvwrmsnorm = Some(weighted_rms_norm);
    ops.nvwrmsnormmask = Some(weighted_rms_norm_masked);
}

/// Creates a vector like `w`, filled with zeros: the library leaves its entries undefined, which must not become a
/// slice.
unsafe extern "C" fn clone(w: N_Vector) -> N_Vector {
    // SAFETY: SUNDIALS passes a valid vector; the new one has just been created, null is checked.
    unsafe {
        let v = N_VClone_Serial(w);
        if !v.is_null() {
            let (n, data) = parts(v);
            std::ptr::write_bytes(data, 0, n);
        }
        v
    }
}

/// `zᵢ = f(xᵢ)`; z may be x.
///
/// # Safety
/// Valid serial vectors of equal length.
#[inline(always)]
unsafe fn map(x: N_Vector, z: N_Vector, f: impl Fn(f64) -> f64) {
    // SAFETY: by contract; the same data are borrowed once, different data are disjoint.
    unsafe {
        if parts(x).1 == parts(z).1 {
            entries_mut(z).iter_mut().for_each(|z| *z = f(*z));
        } else {
            entries_mut(z).iter_mut().zip(entries(x)).for_each(|(z, &x)| *z = f(x));
        }
    }
}

/// `zᵢ = f(xᵢ, yᵢ)`; any of them may be the same vector.
///
/// # Safety
/// Valid serial vectors of equal length.
#[inline(always)]
unsafe fn map2(x: N_Vector, y: N_Vector, z: N_Vector, f: impl Fn(f64, f64) -> f64) {
    // SAFETY: by contract; the written data are borrowed once, different data are disjoint.
    unsafe {
        let (px, py, pz) = (parts(x).1, parts(y).1, parts(z).1);
        if pz == px && pz == py {
            entries_mut(z).iter_mut().for_each(|z| *z = f(*z, *z));
        } else if pz == px {
            entries_mut(z)
                .iter_mut()
                .zip(entries(y))
                .for_each(|(z, &y)| *z = f(*z, y));
        } else if pz == py {
            entries_mut(z)
                .iter_mut()
                .zip(entries(x))
                .for_each(|(z, &x)| *z = f(x, *z));
        } else {
            entries_mut(z)
                .iter_mut()
                .zip(entries(x))
                .zip(entries(y))
                .for_each(|((z, &x), &y)| *z = f(x, y));
        }
    }
}

/// `z = a x + b y`. Factors of one need no special case: multiplying by them is exact and free.
unsafe extern "C" fn linear_sum(a: f64, x: N_Vector, b: f64, y: N_Vector, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { map2(x, y, z, |x, y| a * x + b * y) }
}

/// `z = Σ cⱼ xⱼ`, block by block; z may be any of the xⱼ, because each block is read from all of them before it is written.
unsafe extern "C" fn linear_combination(count: c_int, c: *mut f64, x: *mut N_Vector, z: N_Vector) -> c_int {
    const BLOCK: usize = 64;
    if count < 1 {
        return -1;
    }
    // SAFETY: SUNDIALS passes `count` factors and valid vectors of equal length.
    unsafe {
        let (c, x) = (
            slice::from_raw_parts(c, count as usize),
            slice::from_raw_parts(x, count as usize),
        );
        let (n, out) = parts(z);
        let mut start = 0;
        while start < n {
            let length = BLOCK.min(n - start);
            let mut block = [0.0; BLOCK];
            let block = &mut block[..length];
            for (&c, &x) in c.iter().zip(x) {
                let x = slice::from_raw_parts(parts(x).1.add(start), length);
                block.iter_mut().zip(x).for_each(|(sum, &x)| *sum += c * x);
            }
            slice::from_raw_parts_mut(out.add(start), length).copy_from_slice(block);
            start += length;
        }
    }
    0
}

/// `zᵢ = c`.
unsafe extern "C" fn fill(c: f64, z: N_Vector) {
    // SAFETY: SUNDIALS passes a valid vector.
    unsafe { entries_mut(z) }.fill(c);
}

/// `zᵢ = xᵢ yᵢ`.
unsafe extern "C" fn product(x: N_Vector, y: N_Vector, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { map2(x, y, z, |x, y| x * y) }
}

/// `zᵢ = xᵢ / yᵢ`.
unsafe extern "C" fn quotient(x: N_Vector, y: N_Vector, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { map2(x, y, z, |x, y| x / y) }
}

/// `zᵢ = c xᵢ`.
unsafe extern "C" fn scale(c: f64, x: N_Vector, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length; `copy` allows equal data.
    unsafe {
        if c == 1.0 {
            let ((n, from), (_, to)) = (parts(x), parts(z));
            std::ptr::copy(from, to, n);
        } else {
            map(x, z, |x| c * x);
        }
    }
}

/// `zᵢ = |xᵢ|`.
unsafe extern "C" fn abs(x: N_Vector, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { map(x, z, f64::abs) }
}

/// `zᵢ = 1 / xᵢ`.
unsafe extern "C" fn inverse(x: N_Vector, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { map(x, z, |x| 1.0 / x) }
}

/// `zᵢ = xᵢ + b`.
unsafe extern "C" fn add_constant(x: N_Vector, b: f64, z: N_Vector) {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { map(x, z, |x| x + b) }
}

/// `Σ xᵢ yᵢ`.
unsafe extern "C" fn dot(x: N_Vector, y: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { kernels::dot(entries(x), entries(y)) }
}

/// `max |xᵢ|`.
unsafe extern "C" fn max_norm(x: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes a valid vector.
    kernels::max_abs(unsafe { entries(x) })
}

/// `min xᵢ`.
unsafe extern "C" fn min(x: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes a valid vector.
    kernels::min(unsafe { entries(x) })
}

/// `Σ |xᵢ|`.
unsafe extern "C" fn l1_norm(x: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes a valid vector.
    kernels::sum_abs(unsafe { entries(x) })
}

/// `√Σ (xᵢ wᵢ)²`.
unsafe extern "C" fn weighted_l2_norm(x: N_Vector, w: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    unsafe { kernels::weighted_square(entries(x), entries(w)) }.sqrt()
}

/// `√(Σ (xᵢ wᵢ)² / n)`.
unsafe extern "C" fn weighted_rms_norm(x: N_Vector, w: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    let (x, w) = unsafe { (entries(x), entries(w)) };
    (kernels::weighted_square(x, w) / x.len() as f64).sqrt()
}

/// `√(Σ (xᵢ wᵢ)² / n)`, the sum over entries with `idᵢ > 0`.
unsafe extern "C" fn weighted_rms_norm_masked(x: N_Vector, w: N_Vector, id: N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes valid vectors of equal length.
    let (x, w, id) = unsafe { (entries(x), entries(w), entries(id)) };
    (kernels::weighted_square_masked(x, w, id) / x.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use sundials_sys as s;

    use super::*;
    use crate::sundials::context::Context;
    use crate::sundials::vector::Vector;

    /// Vectors x, y, w of order one, without zeros.
    fn trio(n: usize, context: &Context, stock: bool) -> [Vector; 3] {
        [0.3, 1.7, 2.9].map(|phase| {
            let entries: Vec<f64> = (0..n).map(|i| 1.5 + (phase + 0.7 * i as f64).sin()).collect();
            let make = if stock {
                Vector::with_stock_operations
            } else {
                Vector::new
            };
            make(&entries, context.raw()).unwrap()
        })
    }

    /// Each operation, with every aliasing SUNDIALS allows, equals SUNDIALS' own.
    /// Tolerance: elementwise two roundings; reductions n roundings of terms of order ten.
    #[test]
    fn operations_equal_the_library_under_all_aliasing() {
        let context = Context::new().unwrap();
        for n in [1, 5, 8, 63, 64, 65, 200] {
            // (x, y, z) as indices into the trio: distinct, z = x, z = y, x = y, all equal
            for [x, y, z] in [[0, 1, 2], [0, 1, 0], [0, 1, 1], [0, 0, 2], [0, 0, 0]] {
                let fills: [&dyn Fn([N_Vector; 3]); 12] = [
                    &|[x, y, z]| unsafe { s::N_VLinearSum(0.7, x, -1.3, y, z) },
                    &|[x, y, z]| unsafe { s::N_VLinearSum(1.0, x, 1.0, y, z) },
                    &|[x, y, z]| unsafe { s::N_VLinearSum(-1.0, x, 1.0, y, z) },
                    &|[x, y, z]| unsafe { s::N_VLinearSum(1.0, x, 0.1, y, z) },
                    &|[x, y, z]| unsafe { s::N_VProd(x, y, z) },
                    &|[x, y, z]| unsafe { s::N_VDiv(x, y, z) },
                    &|[x, _, z]| unsafe { s::N_VScale(1.0, x, z) },
                    &|[x, _, z]| unsafe { s::N_VScale(-0.4, x, z) },
                    &|[x, _, z]| unsafe { s::N_VAbs(x, z) },
                    &|[x, _, z]| unsafe { s::N_VInv(x, z) },
                    &|[x, _, z]| unsafe { s::N_VAddConst(x, 2.5, z) },
                    &|[_, _, z]| unsafe { s::N_VConst(2.5, z) },
                ];
                let reductions: [&dyn Fn([N_Vector; 3]) -> f64; 6] = [
                    &|[x, y, _]| unsafe { s::N_VDotProd(x, y) },
                    &|[x, y, _]| unsafe { s::N_VWrmsNorm(x, y) },
                    &|[x, y, z]| unsafe { s::N_VWrmsNormMask(x, y, z) },
                    &|[x, y, _]| unsafe { s::N_VWL2Norm(x, y) },
                    &|[x, _, _]| unsafe { s::N_VMaxNorm(x) + s::N_VL1Norm(x) + s::N_VMin(x) },
                    &|[x, y, z]| unsafe {
                        // z as a summand comes first and only once, as SUNDIALS requires
                        let mut vectors = if z == y { [y, x] } else { [x, y] };
                        let count = if x == y { 1 } else { 2 };
                        s::N_VLinearCombination(count, [0.3, 0.9].as_mut_ptr(), vectors.as_mut_ptr(), z).into()
                    },
                ];
                let fills = fills.iter().map(|fill| -> Box<dyn Fn([N_Vector; 3]) -> f64 + '_> {
                    Box::new(|vectors| {
                        fill(vectors);
                        0.0
                    })
                });
                let operations = fills.chain(reductions.iter().map(|reduce| Box::new(reduce) as Box<_>));
                for (number, operation) in operations.enumerate() {
                    let (own, stock) = (trio(n, &context, false), trio(n, &context, true));
                    let (a, b) = (
                        operation([own[x].raw(), own[y].raw(), own[z].raw()]),
                        operation([stock[x].raw(), stock[y].raw(), stock[z].raw()]),
                    );
                    let case = format!("operation {number}, n {n}, arguments {x} {y} {z}");
                    assert!(
                        (a - b).abs() <= 10.0 * n as f64 * f64::EPSILON * 10.0,
                        "{case}: {a} {b}"
                    );
                    for (own, stock) in own.iter().zip(&stock) {
                        for (a, b) in own.entries().iter().zip(stock.entries()) {
                            assert!((a - b).abs() <= 4.0 * f64::EPSILON * (1.0 + b.abs()), "{case}: {a} {b}");
                        }
                    }
                }
            }
        }
    }

    /// A clone uses our operations, and long combinations equal the plain sum (five rounding errors of order ten).
    #[test]
    fn clones_inherit_operations() {
        let context = Context::new().unwrap();
        let [x, y, z] = trio(131, &context, false);
        let clone = Vector::adopt(unsafe { s::N_VClone(x.raw()) });
        assert!(clone.entries().iter().all(|&entry| entry == 0.0));
        let (ours, theirs) = unsafe { ((*(*x.raw()).ops).nvwrmsnorm, (*(*clone.raw()).ops).nvwrmsnorm) };
        assert!(theirs.is_some() && ours.map(|f| f as usize) == theirs.map(|f| f as usize));
        let mut c = [0.1, -2.0, 3.0, 0.5, 1.0];
        let mut vectors = [x.raw(), y.raw(), z.raw(), y.raw(), x.raw()];
        assert_eq!(
            unsafe { s::N_VLinearCombination(5, c.as_mut_ptr(), vectors.as_mut_ptr(), clone.raw()) },
            0
        );
        for i in 0..131 {
            let [x, y, z] = [&x, &y, &z].map(|v| v.entries()[i]);
            let plain = 0.1 * x - 2.0 * y + 3.0 * z + 0.5 * y + x;
            assert!((clone.entries()[i] - plain).abs() <= 50.0 * f64::EPSILON);
        }
    }
}

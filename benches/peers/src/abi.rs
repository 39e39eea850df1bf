//! C interface to the equations of a scene, used by benches/c/ida.c.
//!
//! SAFETY, of all functions: a handle is from `scene_open` and not yet passed to `scene_close`; arrays have the documented lengths.
#![allow(clippy::missing_safety_doc)]

use std::ffi::{CStr, c_char, c_int};

use slcbeam::dae::{Dae, Seeds};

use crate::scene::{Bare, Scene};

/// A scene with its equations.
pub struct Handle {
    scene: Scene,
    dae: Bare,
}

/// Opens the scene of a name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_open(name: *const c_char) -> *mut Handle {
    let name = unsafe { CStr::from_ptr(name) }.to_str().expect("a name");
    let scene = Scene::named(name);
    let dae = scene.dae();
    Box::into_raw(Box::new(Handle { scene, dae }))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_close(handle: *mut Handle) {
    drop(unsafe { Box::from_raw(handle) });
}

/// Number of unknowns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_unknowns(handle: *const Handle) -> c_int {
    unsafe { &*handle }.scene.y.len() as c_int
}

/// Number of entries of the Jacobian.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_entries(handle: *const Handle) -> c_int {
    unsafe { &*handle }.dae.pattern().entries() as c_int
}

/// Sparsity pattern of the Jacobian by columns: unknowns + 1 starts, entries rows.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_pattern(handle: *const Handle, starts: *mut i64, rows: *mut i64) {
    let pattern = unsafe { &*handle }.dae.pattern();
    unsafe {
        std::ptr::copy_nonoverlapping(pattern.starts.as_ptr(), starts, pattern.starts.len());
        std::ptr::copy_nonoverlapping(pattern.rows.as_ptr(), rows, pattern.rows.len());
    }
}

/// Consistent values and rates at t = 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_start(handle: *const Handle, y: *mut f64, yp: *mut f64) {
    let scene = &unsafe { &*handle }.scene;
    unsafe {
        std::ptr::copy_nonoverlapping(scene.y.as_ptr(), y, scene.y.len());
        std::ptr::copy_nonoverlapping(scene.yp.as_ptr(), yp, scene.yp.len());
    }
}

/// Number of output times after t = 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_outputs(handle: *const Handle) -> c_int {
    unsafe { &*handle }.scene.times.len() as c_int
}

/// Output time number `k` [s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_output(handle: *const Handle, k: c_int) -> f64 {
    unsafe { &*handle }.scene.times[k as usize]
}

/// Tip deflection [m] and pressure at the tip [Pa].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_read(handle: *const Handle, y: *const f64, out: *mut f64) {
    let scene = &unsafe { &*handle }.scene;
    let y = unsafe { std::slice::from_raw_parts(y, scene.y.len()) };
    let [tip, pressure] = scene.readings.read(y);
    unsafe {
        *out = tip;
        *out.add(1) = pressure;
    }
}

/// `F(t, y, y')`; returns 0 on success.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_residual(
    handle: *mut Handle,
    t: f64,
    y: *const f64,
    yp: *const f64,
    r: *mut f64,
) -> c_int {
    let own = unsafe { &mut *handle };
    let n = own.scene.y.len();
    let (y, yp, r) = unsafe {
        (
            std::slice::from_raw_parts(y, n),
            std::slice::from_raw_parts(yp, n),
            std::slice::from_raw_parts_mut(r, n),
        )
    };
    c_int::from(own.dae.residual(t, y, yp, r).is_err())
}

/// Entries of `∂F/∂y + cj ∂F/∂y'`; returns 0 on success.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scene_jacobian(
    handle: *mut Handle,
    t: f64,
    cj: f64,
    y: *const f64,
    yp: *const f64,
    values: *mut f64,
) -> c_int {
    let own = unsafe { &mut *handle };
    let (n, entries) = (own.scene.y.len(), own.dae.pattern().entries());
    let (y, yp, values) = unsafe {
        (
            std::slice::from_raw_parts(y, n),
            std::slice::from_raw_parts(yp, n),
            std::slice::from_raw_parts_mut(values, entries),
        )
    };
    c_int::from(own.dae.jacobian(t, y, yp, Seeds::Step { cj }, values).is_err())
}

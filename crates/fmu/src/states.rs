//! States of instances: stored, restored, and as bytes.

use std::ffi::c_void;

use crate::instance::InstanceState;
use crate::{Status, guarded, put, slice};

/// State behind an `fmi3FMUState`.
///
/// # Safety
/// `state` is null, or from [`fmi3GetFMUState`] or [`fmi3DeserializeFMUState`] and not freed.
unsafe fn behind<'a>(state: *mut c_void) -> Result<&'a InstanceState, String> {
    // SAFETY: null, or a state by contract.
    unsafe { state.cast::<InstanceState>().as_ref() }.ok_or_else(|| "there is no state".into())
}

fn bytes(state: &InstanceState) -> Result<Vec<u8>, String> {
    serde_json::to_vec(state).map_err(|why| why.to_string())
}

/// Puts a state into a place for a pointer: into the state that is there, or into a new one.
///
/// # Safety
/// `place` is valid, and contains null or a state.
unsafe fn store(place: *mut *mut c_void, state: InstanceState) {
    // SAFETY: valid by contract; a state that is there is replaced.
    match unsafe { (*place).cast::<InstanceState>().as_mut() } {
        Some(there) => *there = state,
        // SAFETY: valid by contract.
        None => unsafe { put(place, Box::into_raw(Box::new(state)).cast()) },
    }
}

/// Stores the state of an instance. The instance then continues exactly like one that restores the state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, state: *mut *mut c_void) -> Status {
    // SAFETY: an instance, and a place with null or a state, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3GetFMUState", |handle| {
            store(state, handle.instance.save()?);
            Ok(Status::Ok)
        })
    }
}

/// Restores a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: *mut c_void, state: *mut c_void) -> Status {
    // SAFETY: an instance and a state by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3SetFMUState", |handle| {
            handle.instance.restore(behind(state)?)?;
            Ok(Status::Ok)
        })
    }
}

/// Frees a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: *mut c_void, state: *mut *mut c_void) -> Status {
    // SAFETY: an instance, and null or a place with null or a state, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3FreeFMUState", |_| {
            if !state.is_null() && !(*state).is_null() {
                drop(Box::from_raw((*state).cast::<InstanceState>()));
                put(state, std::ptr::null_mut());
            }
            Ok(Status::Ok)
        })
    }
}

/// Number of bytes of a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut c_void,
    state: *mut c_void,
    size: *mut usize,
) -> Status {
    // SAFETY: an instance, a state, and a place for the result, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3SerializedFMUStateSize", |_| {
            put(size, bytes(behind(state)?)?.len());
            Ok(Status::Ok)
        })
    }
}

/// Writes a state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut c_void,
    state: *mut c_void,
    to: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: an instance, a state, and `size` places for bytes, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3SerializeFMUState", |_| {
            let all = bytes(behind(state)?)?;
            if all.len() != size {
                return Err(format!("the state has {} bytes, the buffer has {size}", all.len()));
            }
            std::ptr::copy_nonoverlapping(all.as_ptr(), to, size);
            Ok(Status::Ok)
        })
    }
}

/// Reads a state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut c_void,
    from: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> Status {
    // SAFETY: an instance, `size` bytes, and a place with null or a state, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3DeserializeFMUState", |_| {
            let read = serde_json::from_slice(slice(from, size));
            store(state, read.map_err(|why| format!("not a state of an FMU: {why}"))?);
            Ok(Status::Ok)
        })
    }
}

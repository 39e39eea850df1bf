//! SUNDIALS' serial vectors, owned by Rust, with the operations of [`super::operations`].

use std::slice;

use sundials_sys::{_N_VectorContent_Serial, N_VDestroy, N_VNew_Serial, N_Vector, SUNContext};

use super::operations;

/// Owner of a vector.
pub(super) struct Vector(N_Vector);

impl Vector {
    /// Creates a vector with these entries.
    pub fn new(entries: &[f64], context: SUNContext) -> Result<Self, String> {
        let vector = Self::with_stock_operations(entries, context)?;
        // SAFETY: a serial vector has its own table of operations, which is freed with it.
        operations::replace(unsafe { &mut *(*vector.0).ops });
        Ok(vector)
    }

    /// Creates a vector with SUNDIALS' own operations.
    pub fn with_stock_operations(entries: &[f64], context: SUNContext) -> Result<Self, String> {
        // SAFETY: the context is alive; null is checked.
        let raw = unsafe { N_VNew_Serial(entries.len() as i64, context) };
        if raw.is_null() {
            return Err("no memory for a vector".to_owned());
        }
        // SAFETY: the new vector has as many entries, still undefined, and does not overlap `entries`.
        unsafe { std::ptr::copy_nonoverlapping(entries.as_ptr(), parts(raw).1, entries.len()) };
        Ok(Self(raw))
    }

    /// Adopts a vector created by SUNDIALS, which is destroyed with this owner.
    #[cfg(test)]
    pub fn adopt(raw: N_Vector) -> Self {
        Self(raw)
    }

    /// Vector handle for C.
    pub fn raw(&self) -> N_Vector {
        self.0
    }

    /// Entries of the vector.
    pub fn entries(&self) -> &[f64] {
        // SAFETY: a serial vector; C does not run while the borrow lasts, because calls into C take `&mut` of the owner.
        unsafe { entries(self.0) }
    }

    /// Mutable entries of the vector.
    pub fn entries_mut(&mut self) -> &mut [f64] {
        // SAFETY: as in `entries`, borrowed mutably.
        unsafe { entries_mut(self.0) }
    }
}

impl Drop for Vector {
    fn drop(&mut self) {
        // SAFETY: created by `N_VNew_Serial`, destroyed once.
        unsafe { N_VDestroy(self.0) };
    }
}

/// Length and data of a serial vector.
///
/// # Safety
/// `v` is a valid serial vector.
#[inline(always)]
pub(super) unsafe fn parts(v: N_Vector) -> (usize, *mut f64) {
    // SAFETY: by contract; the content of a serial vector is this structure.
    let content = unsafe { &*(*v).content.cast::<_N_VectorContent_Serial>() };
    if content.data.is_null() {
        (0, std::ptr::NonNull::dangling().as_ptr())
    } else {
        (content.length as usize, content.data)
    }
}

/// Entries of a serial vector.
///
/// # Safety
/// `v` is a valid serial vector, and nobody writes to it while the slice is used.
#[inline(always)]
pub(super) unsafe fn entries<'v>(v: N_Vector) -> &'v [f64] {
    // SAFETY: by contract.
    unsafe {
        let (n, data) = parts(v);
        slice::from_raw_parts(data, n)
    }
}

/// Mutable entries of a serial vector.
///
/// # Safety
/// `v` is a valid serial vector, and nobody else accesses it while the slice is used.
#[inline(always)]
pub(super) unsafe fn entries_mut<'v>(v: N_Vector) -> &'v mut [f64] {
    // SAFETY: by contract.
    unsafe {
        let (n, data) = parts(v);
        slice::from_raw_parts_mut(data, n)
    }
}

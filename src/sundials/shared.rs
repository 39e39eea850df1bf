//! Values to which both Rust and C have pointers.

use std::ptr::NonNull;

/// A boxed value with a fixed address that C may store; it exists until this owner is dropped.
///
/// Not a `Box`, because moving a box asserts that no other pointer into it is used again.
pub(super) struct Shared<T>(NonNull<T>);

impl<T> Shared<T> {
    /// Moves a value to a fixed address.
    pub fn new(value: T) -> Self {
        // SAFETY: a box is never null.
        Self(unsafe { NonNull::new_unchecked(Box::into_raw(Box::new(value))) })
    }

    /// Address for C.
    pub fn pointer(&self) -> *mut T {
        self.0.as_ptr()
    }

    /// Reference to the value; must end before C runs again.
    pub fn get(&self) -> &T {
        // SAFETY: the value lives as long as self; C accesses it only inside calls, during which no method of this
        // module has a reference.
        unsafe { self.0.as_ref() }
    }

    /// Mutable reference to the value; must end before C runs again.
    pub fn get_mut(&mut self) -> &mut T {
        // SAFETY: as in `get`, and self is borrowed mutably.
        unsafe { self.0.as_mut() }
    }

    /// Returns the value; C must not use the address any more.
    pub fn into_inner(self) -> T {
        let pointer = self.0.as_ptr();
        std::mem::forget(self);
        // SAFETY: the pointer was created from a box in `new` and is freed once, because the destructor is skipped.
        *unsafe { Box::from_raw(pointer) }
    }
}

impl<T> Drop for Shared<T> {
    fn drop(&mut self) {
        // SAFETY: the pointer was created from a box in `new` and is freed once.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

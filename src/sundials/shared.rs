//! What Rust and C both point to.

use std::ptr::NonNull;

/// A boxed value whose address C keeps: it does not move and stays until this owner is dropped.
///
/// Not a `Box`, because moving a box asserts that no other pointer into it is used again.
pub(super) struct Shared<T>(NonNull<T>);

impl<T> Shared<T> {
    /// Puts a value where C may point to it.
    pub fn new(value: T) -> Self {
        // SAFETY: a box is never null.
        Self(unsafe { NonNull::new_unchecked(Box::into_raw(Box::new(value))) })
    }

    /// Address for C.
    pub fn pointer(&self) -> *mut T {
        self.0.as_ptr()
    }

    /// The value, to be let go before C runs again.
    pub fn get(&self) -> &T {
        // SAFETY: the value lives as long as self; C reaches it only inside calls, over which no method of this
        // room holds a reference.
        unsafe { self.0.as_ref() }
    }

    /// The value, to be let go before C runs again.
    pub fn get_mut(&mut self) -> &mut T {
        // SAFETY: as in `get`, and self is borrowed mutably.
        unsafe { self.0.as_mut() }
    }

    /// The value, taken back; C must not use the address any more.
    pub fn into_inner(self) -> T {
        let pointer = self.0.as_ptr();
        std::mem::forget(self);
        // SAFETY: the pointer came from a box in `new` and is given back once, the destructor being forgotten.
        *unsafe { Box::from_raw(pointer) }
    }
}

impl<T> Drop for Shared<T> {
    fn drop(&mut self) {
        // SAFETY: the pointer came from a box in `new` and is given back once.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

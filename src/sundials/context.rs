//! SUNDIALS' context, and the handler of its messages.

use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;

use sundials_sys::{SUNContext, SUNContext_Create, SUNContext_Free};

/// Version of the loaded SUNDIALS library.
pub(super) fn loaded() -> [c_int; 3] {
    let (mut major, mut minor, mut patch) = (0, 0, 0);
    let mut label = [0 as c_char; 32];
    // SAFETY: the pointers are valid for writing and the label's length is passed.
    unsafe { crate::sparse::c::SUNDIALSGetVersionNumber(&mut major, &mut minor, &mut patch, label.as_mut_ptr(), 32) };
    [major, minor, patch]
}

/// Owner of a context; every SUNDIALS object belongs to one. One per integrator, bound to its thread.
pub(super) struct Context(SUNContext);

impl Context {
    /// Creates a context; fails if the loaded library differs from the headers, or for lack of memory.
    pub fn new() -> Result<Self, String> {
        let [major, minor, patch] = loaded();
        let built = (
            sundials_sys::SUNDIALS_VERSION_MAJOR,
            sundials_sys::SUNDIALS_VERSION_MINOR,
        );
        if (major as u32, minor as u32) != built {
            let (one, other) = built;
            return Err(format!(
                "the program was built for SUNDIALS {one}.{other}, but loaded {major}.{minor}.{patch}"
            ));
        }
        let mut context = ptr::null_mut();
        // SAFETY: null means no communicator; the context is written on success.
        let flag = unsafe { SUNContext_Create(ptr::null_mut(), &mut context) };
        if flag != 0 || context.is_null() {
            return Err("SUNDIALS could not create a context".to_owned());
        }
        Ok(Self(context))
    }

    /// Pointer for functions that create C objects.
    pub fn raw(&self) -> SUNContext {
        self.0
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: created in `new`, freed once; the fields of `Ida` are ordered so that it outlives all objects that
        // use it.
        unsafe { SUNContext_Free(&mut self.0) };
    }
}

/// Last message that SUNDIALS would have printed.
#[derive(Default)]
pub(super) struct Messages(RefCell<String>);

impl Messages {
    /// Returns and removes the message.
    pub fn take(&self) -> String {
        self.0.take()
    }
}

/// Error handler for SUNDIALS: stores the message instead of printing it. `data` points to [`Messages`].
pub(super) unsafe extern "C" fn keep(
    _code: c_int,
    _module: *const c_char,
    _function: *const c_char,
    message: *mut c_char,
    data: *mut c_void,
) {
    // SAFETY: the pointer was given with this handler and its value outlives the solver; shared references only.
    let messages = unsafe { &*data.cast::<Messages>() };
    if !message.is_null() {
        // SAFETY: SUNDIALS passes a terminated string that lives during the call.
        let text = unsafe { CStr::from_ptr(message) }.to_string_lossy().trim().to_owned();
        messages.0.replace(text);
    }
}

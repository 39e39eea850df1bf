//! Messages to the importer.

use std::ffi::{CString, c_char, c_void};

use crate::Status;

/// `fmi3LogMessageCallback`.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// Receiver of the messages of an instance.
pub struct Logger {
    environment: *mut c_void,
    log: Option<LogMessage>,
    /// True if warnings are passed on; errors always are.
    pub on: bool,
}

impl Logger {
    /// Receiver as the importer gives it.
    pub fn new(environment: *mut c_void, log: Option<LogMessage>, on: bool) -> Self {
        Self { environment, log, on }
    }

    /// Passes on an error.
    pub fn error(&self, text: &str) {
        self.pass(Status::Error, c"logStatusError", text);
    }

    /// Passes on a warning.
    pub fn warning(&self, text: &str) {
        if self.on {
            self.pass(Status::Warning, c"logStatusWarning", text);
        }
    }

    fn pass(&self, status: Status, category: &std::ffi::CStr, text: &str) {
        let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
        if let Some(log) = self.log {
            // SAFETY: the importer's function and environment, valid while the instance exists; the texts outlive the call.
            unsafe { log(self.environment, status, category.as_ptr(), text.as_ptr()) };
        }
    }
}

//! The C interface of FMI 3.0 for FMUs that `slcbeam export --fmu` writes.
//!
//! Source: FMI 3.0.2, `fmi3FunctionTypes.h`. Functions for co-simulation are complete; those for other kinds of FMUs, and for types of
//! variables that these FMUs do not have, fail. There are no global variables: instances are independent. Panics end at this interface.
#![allow(non_snake_case, clippy::missing_safety_doc)]

mod absent;
mod instance;
mod log;
mod states;

use std::ffi::{CStr, c_char, c_void};
use std::path::PathBuf;

use instance::{Instance, Phase, StepOutcome};
use log::{LogMessage, Logger};

/// `fmi3Status`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok,
    /// Done, with a warning.
    Warning,
    /// Not done, without consequences.
    Discard,
    /// Failed; the importer may reset the instance, or return to a stored state.
    Error,
    /// Failed for all instances.
    Fatal,
}

/// An instance behind an `fmi3Instance`.
struct Handle {
    instance: Instance,
    logger: Logger,
    /// True after a panic.
    broken: bool,
}

/// Result of a call: its status, or the text of an error.
type Outcome = Result<Status, String>;

/// Calls a function for an instance, reports its error, and stops a panic.
///
/// # Safety
/// `instance` is null, or from [`fmi3InstantiateCoSimulation`] and not freed, and is not used by another thread at this time.
unsafe fn guarded(instance: *mut c_void, call: &str, act: impl FnOnce(&mut Handle) -> Outcome) -> Status {
    // SAFETY: the pointer is null or that of a `Handle`, which nothing else uses now.
    let Some(handle) = (unsafe { instance.cast::<Handle>().as_mut() }) else {
        return Status::Error;
    };
    if handle.broken {
        return Status::Fatal;
    }
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| act(handle))) {
        Ok(Ok(status)) => status,
        Ok(Err(why)) => {
            handle.logger.error(&format!("{call}: {why}"));
            Status::Error
        }
        Err(_) => {
            handle.broken = true;
            handle.logger.error(&format!("{call}: internal error"));
            Status::Fatal
        }
    }
}

/// Elements behind a pointer of C; none for a count of zero.
///
/// # Safety
/// `from` points to `count` elements, which live and do not change for as long as the slice is used; any pointer for a count of zero.
unsafe fn slice<'a, T>(from: *const T, count: usize) -> &'a [T] {
    match count == 0 || from.is_null() {
        true => &[],
        // SAFETY: not null, and `count` elements by contract.
        false => unsafe { std::slice::from_raw_parts(from, count) },
    }
}

/// Text behind a pointer of C, if it is not null.
///
/// # Safety
/// `text` is null or points to a text that ends with a zero.
unsafe fn string(text: *const c_char) -> Option<String> {
    // SAFETY: not null, and ends with a zero by contract.
    (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned())
}

/// Writes a value to a place of C, unless it is null.
///
/// # Safety
/// `place` is null or valid for a write.
unsafe fn put<T>(place: *mut T, value: T) {
    if !place.is_null() {
        // SAFETY: not null, and valid by contract.
        unsafe { place.write(value) };
    }
}

/// Version of FMI. The text of the version of this library stands behind it.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Text by which the program recognizes a library of its version.
#[unsafe(no_mangle)]
pub static SLCBEAM_FMU_LIBRARY: [u8; slcbeam::output::fmu::MARK.len()] = {
    let (from, mut own, mut k) = (
        slcbeam::output::fmu::MARK.as_bytes(),
        [0; slcbeam::output::fmu::MARK.len()],
        0,
    );
    while k < own.len() {
        own[k] = from[k];
        k += 1;
    }
    own
};

/// Creates an instance; null if its resources cannot be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    logging: bool,
    events: bool,
    early_return: bool,
    _intermediate: *const u32,
    _intermediates: usize,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _update: *const c_void,
) -> *mut c_void {
    let logger = Logger::new(environment, log, logging);
    // SAFETY: texts of C, or null, by the contract of FMI.
    let [token, resources] = unsafe { [string(token), string(resources)] };
    let made = std::panic::catch_unwind(|| {
        let resources = resources.ok_or("fmi3InstantiateCoSimulation: the path of the resources is missing")?;
        Instance::new(PathBuf::from(resources), &token.unwrap_or_default())
    });
    match made.unwrap_or_else(|_| Err("internal error".into())) {
        Ok(mut instance) => {
            (instance.events, instance.early_return) = (events, early_return);
            Box::into_raw(Box::new(Handle {
                instance,
                logger,
                broken: false,
            }))
            .cast()
        }
        Err(why) => {
            logger.error(&why);
            std::ptr::null_mut()
        }
    }
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: from `Box::into_raw`, and freed once, by the contract of FMI.
        let handle = unsafe { Box::from_raw(instance.cast::<Handle>()) };
        let _ = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| drop(handle)));
    }
}

/// Switches messages on or off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    // SAFETY: an instance by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3SetDebugLogging", |handle| {
            handle.logger.on = on;
            Ok(Status::Ok)
        })
    }
}

/// Creates the model of an instance, at the start of its case.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    stop_defined: bool,
    stop: f64,
) -> Status {
    let call = "fmi3EnterInitializationMode";
    // SAFETY: an instance by the contract of FMI.
    unsafe {
        guarded(instance, call, |handle| {
            handle.instance.require(&[Phase::Instantiated], call)?;
            handle.instance.begin(start, stop_defined.then_some(stop))?;
            Ok(Status::Ok)
        })
    }
}

/// Defines functions that change the phase of an instance: name, allowed phases, next phase.
macro_rules! transitions {
    ($($(#[$about:meta])* $name:ident: [$($from:ident),*] => $to:expr;)*) => {$(
        $(#[$about])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut c_void) -> Status {
            // SAFETY: an instance by the contract of FMI.
            unsafe {
                guarded(instance, stringify!($name), |handle| {
                    handle.instance.require(&[$(Phase::$from),*], stringify!($name))?;
                    let next: fn(&Instance) -> Phase = $to;
                    let next = next(&handle.instance);
                    handle.instance.enter(next);
                    Ok(Status::Ok)
                })
            }
        }
    )*};
}

transitions! {
    /// Ends the initialization.
    fmi3ExitInitializationMode: [Initialization] => |own| if own.events { Phase::Event } else { Phase::Step };
    /// Enters event mode.
    fmi3EnterEventMode: [Step] => |_| Phase::Event;
    /// Leaves event mode.
    fmi3EnterStepMode: [Event] => |_| Phase::Step;
}

/// Ends the simulation, and reports its warnings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: *mut c_void) -> Status {
    // SAFETY: an instance by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3Terminate", |handle| {
            handle.instance.require(&[Phase::Step, Phase::Event], "fmi3Terminate")?;
            if handle.logger.on {
                handle
                    .instance
                    .warnings()
                    .iter()
                    .for_each(|text| handle.logger.warning(text));
            }
            handle.instance.enter(Phase::Terminated);
            Ok(Status::Ok)
        })
    }
}

/// Returns to the state after instantiation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: *mut c_void) -> Status {
    // SAFETY: an instance by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3Reset", |handle| {
            handle.instance.reset();
            Ok(Status::Ok)
        })
    }
}

/// Reports the next jump of a signal of the case; all else stays as it is at events.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: *mut c_void,
    needs_update: *mut bool,
    terminate: *mut bool,
    nominals_changed: *mut bool,
    values_changed: *mut bool,
    next_defined: *mut bool,
    next: *mut f64,
) -> Status {
    // SAFETY: an instance, and places for results, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3UpdateDiscreteStates", |handle| {
            handle.instance.require(&[Phase::Event], "fmi3UpdateDiscreteStates")?;
            let event = handle.instance.next_event();
            for place in [needs_update, terminate, nominals_changed, values_changed] {
                put(place, false);
            }
            put(next_defined, event.is_some());
            put(next, event.unwrap_or_default());
            Ok(Status::Ok)
        })
    }
}

/// Simulates a step, during which the inputs are constant.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    from: f64,
    size: f64,
    _no_rollback: bool,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last: *mut f64,
) -> Status {
    // SAFETY: an instance, and places for results, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3DoStep", |handle| {
            let mut outcome = StepOutcome::default();
            let done = handle.instance.require(&[Phase::Step], "fmi3DoStep");
            let done = done.and_then(|()| handle.instance.step(from, size, &mut outcome));
            put(event, outcome.event);
            put(terminate, outcome.ended.is_some());
            put(early, outcome.early);
            put(last, outcome.time);
            done?;
            match &outcome.ended {
                Some(why) => {
                    handle.logger.warning(&format!("fmi3DoStep: {why}"));
                    Ok(Status::Warning)
                }
                None => Ok(Status::Ok),
            }
        })
    }
}

/// Reads variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    _places: usize,
) -> Status {
    // SAFETY: an instance, references, and as many places for results, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3GetFloat64", |handle| {
            let mut own = vec![0.0; count];
            handle.instance.get(slice(references, count), &mut own)?;
            for (k, value) in own.into_iter().enumerate() {
                put(values.add(k), value);
            }
            Ok(Status::Ok)
        })
    }
}

/// Sets inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    _places: usize,
) -> Status {
    // SAFETY: an instance, references, and as many values, by the contract of FMI.
    unsafe {
        guarded(instance, "fmi3SetFloat64", |handle| {
            handle
                .instance
                .set_all(slice(references, count), slice(values, count))?;
            Ok(Status::Ok)
        })
    }
}

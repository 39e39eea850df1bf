//! Functions that every FMU exports, but that these FMUs do not support: they fail with a message.

use std::ffi::{c_char, c_void};
use std::ptr::null_mut;

use crate::{Status, guarded};

/// Array or place of C.
type Place = *mut c_void;

/// Defines functions that fail, by the types of their arguments behind the instance.
macro_rules! absent {
    ($(($($kind:ty),*): $($name:ident)*;)*) => {
        $(absent!(@each ($($kind),*) $($name)*);)*
    };
    (@each $kinds:tt $($name:ident)*) => {
        $(absent!(@one $kinds $name);)*
    };
    (@one ($($kind:ty),*) $name:ident) => {
        /// Not supported.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: Place $(, _: $kind)*) -> Status {
            // SAFETY: an instance by the contract of FMI.
            unsafe {
                guarded(instance, stringify!($name), |_| {
                    Err("this FMU does not support it; all of its variables are Float64, and its kind is co-simulation".into())
                })
            }
        }
    };
}

absent! {
    (): fmi3EnterConfigurationMode fmi3ExitConfigurationMode fmi3EvaluateDiscreteStates fmi3EnterContinuousTimeMode;
    (f64): fmi3SetTime;
    (Place): fmi3GetNumberOfEventIndicators fmi3GetNumberOfContinuousStates;
    (Place, usize): fmi3SetContinuousStates fmi3GetContinuousStateDerivatives fmi3GetEventIndicators fmi3GetContinuousStates
        fmi3GetNominalsOfContinuousStates;
    (Place, usize, Place): fmi3GetClock fmi3SetClock fmi3GetShiftDecimal fmi3SetIntervalDecimal fmi3SetShiftDecimal;
    (Place, usize, Place, Place): fmi3GetIntervalDecimal fmi3GetShiftFraction fmi3SetIntervalFraction fmi3SetShiftFraction;
    (Place, usize, Place, Place, Place): fmi3GetIntervalFraction;
    (Place, usize, Place, usize): fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetInt32 fmi3GetUInt32
        fmi3GetInt64 fmi3GetUInt64 fmi3GetBoolean fmi3GetString fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16
        fmi3SetInt32 fmi3SetUInt32 fmi3SetInt64 fmi3SetUInt64 fmi3SetBoolean fmi3SetString;
    (Place, usize, Place, Place, usize): fmi3GetBinary fmi3SetBinary fmi3GetOutputDerivatives;
    (Place, usize, Place, usize, Place, usize, Place, usize): fmi3GetDirectionalDerivative fmi3GetAdjointDerivative;
    (u32, Place): fmi3GetNumberOfVariableDependencies;
    (u32, Place, Place, Place, Place, usize): fmi3GetVariableDependencies;
    (bool, Place, Place): fmi3CompletedIntegratorStep;
    (u32, f64): fmi3ActivateModelPartition;
}

/// Not supported.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    _environment: Place,
    _log: *const c_void,
) -> Place {
    null_mut()
}

/// Not supported.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    _environment: Place,
    _log: *const c_void,
    _update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Place {
    null_mut()
}

//! Why the integrator could not go on.

use std::fmt;

use sundials_sys as s;

/// The unknown whose error is largest against its tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Position.
    pub unknown: usize,
    /// Name, for people.
    pub name: String,
    /// Estimated error (or last Newton correction) over tolerance.
    pub ratio: f64,
}

/// A step that could not be done, or a request that cannot be met.
#[derive(Clone, Debug, PartialEq)]
pub struct IdaFailure {
    /// IDA's code, negative; 0 when the failure is not IDA's.
    pub code: i32,
    /// What the code means.
    pub meaning: &'static str,
    /// The equations' own fatal fault, verbatim.
    pub fatal: Option<String>,
    /// IDA's message, or what was wrong with the request.
    pub message: String,
    /// Time reached [s].
    pub time: f64,
    /// Step last tried [s].
    pub step: f64,
    /// Order of that step.
    pub order: u8,
    /// The unknown that is worst, when a step has been tried.
    pub worst: Option<Worst>,
    /// Last recoverable fault of the equations, if any since the last accepted step.
    pub recoverable: Option<String>,
    /// Name of the unknown whose column had no pivot, when the last matrix was singular.
    pub singular: Option<String>,
}

impl IdaFailure {
    /// A request that cannot be met, at time `time` [s].
    pub(crate) fn request(message: String, time: f64) -> Box<Self> {
        Box::new(Self {
            code: 0,
            meaning: "the request cannot be met",
            fatal: None,
            message,
            time,
            step: 0.0,
            order: 0,
            worst: None,
            recoverable: None,
            singular: None,
        })
    }
}

impl fmt::Display for IdaFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(fatal) = &self.fatal {
            return f.write_str(fatal);
        }
        write!(f, "{} at t = {:.6e} s", self.meaning, self.time)?;
        if self.step != 0.0 {
            write!(f, " with step {:.3e} s of order {}", self.step, self.order)?;
        }
        if let Some(name) = &self.singular {
            write!(f, "; the matrix is singular in the column of {name}")?;
        }
        if let Some(what) = &self.recoverable {
            write!(f, "; {what}")?;
        }
        if let Some(worst) = &self.worst {
            write!(
                f,
                "; worst is {} at {:.1e} times its tolerance",
                worst.name, worst.ratio
            )?;
        }
        if self.code == 0 && !self.message.is_empty() {
            write!(f, ": {}", self.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for IdaFailure {}

/// What IDA's codes mean.
pub(super) fn meaning(code: i32) -> &'static str {
    match code {
        s::IDA_TOO_MUCH_WORK => "too many steps were taken",
        s::IDA_TOO_MUCH_ACC => "the tolerances ask for more than double precision can give",
        s::IDA_ERR_FAIL => "the error test failed too often, or the step became too small",
        s::IDA_CONV_FAIL => "Newton's iteration failed too often, or the step became too small",
        s::IDA_LINIT_FAIL => "the linear solver could not be initialised",
        s::IDA_LSETUP_FAIL => "the matrix could not be evaluated or factored",
        s::IDA_LSOLVE_FAIL => "the linear system could not be solved",
        s::IDA_RES_FAIL => "the equations could not be evaluated",
        s::IDA_REP_RES_ERR => "the equations could not be evaluated, however short the step",
        s::IDA_CONSTR_FAIL => "the constraints could not be met",
        s::IDA_FIRST_RES_FAIL => "the equations could not be evaluated at the start",
        s::IDA_NLS_INIT_FAIL | s::IDA_NLS_SETUP_FAIL | s::IDA_NLS_FAIL => "the nonlinear solver failed",
        s::IDA_MEM_NULL | s::IDA_NO_MALLOC => "the integrator is not initialised",
        s::IDA_MEM_FAIL => "there is no memory left",
        s::IDA_ILL_INPUT => "an input of the integrator is not allowed",
        s::IDA_BAD_EWT => "an error weight is not positive and finite",
        s::IDA_BAD_K => "a derivative of this order is not available",
        s::IDA_BAD_T => "the time is outside the last step",
        s::IDA_VECTOROP_ERR => "a vector operation failed",
        s::IDA_SRES_FAIL | s::IDA_QSRHS_FAIL => "the equations of a sensitivity could not be evaluated",
        s::IDA_REP_SRES_ERR | s::IDA_REP_QSRHS_ERR => {
            "the equations of a sensitivity could not be evaluated, however short the step"
        }
        _ => "the integrator failed",
    }
}

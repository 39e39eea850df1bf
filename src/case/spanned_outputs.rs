//! A case whose controllers are replaced by signals that span their outputs, for estimates before a run.

use std::borrow::Cow;

use super::{Case, controls};

impl Case {
    /// The case with a table in place of each controller, which spans its outputs within the run.
    pub fn with_spanned_outputs(&self) -> Cow<'_, Self> {
        let mut controlled = controls(self);
        controlled.retain(|(.., signal)| signal.is_controlled());
        if controlled.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut names = vec![];
        for (.., signal) in &controlled {
            signal.each_controller(&mut |one| names.push(one.name.clone()));
        }
        let mut value = serde_json::to_value(self).unwrap_or_default();
        for (pointer, _, signal) in controlled {
            if let (Some(place), Ok(spanned)) = (
                value.pointer_mut(&pointer),
                serde_json::to_value(&*signal.spanned_beside(self.time.end_s, &names)),
            ) {
                *place = spanned;
            }
        }
        let spanned = serde_json::from_value(value).map(|case: Self| Self {
            origins: self.origins.clone(),
            source: self.source.clone(),
            ..case
        });
        spanned.map_or(Cow::Borrowed(self), Cow::Owned)
    }
}

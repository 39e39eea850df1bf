//! Warnings with their titles and explanations, grouped by code.

use serde_json::{Value, json};

use crate::error::Code;

/// Groups `{code, title, texts, explanation}` in the order of their first texts. A text without a code is a group of its own.
pub fn groups(texts: &[String]) -> Value {
    let mut all: Vec<(Option<Code>, Vec<&str>)> = vec![];
    for text in texts {
        let numbered = text
            .split_once(' ')
            .and_then(|(id, rest)| Some((Code::find(id)?, rest)));
        let (code, words) = numbered.map_or((None, text.as_str()), |(code, rest)| (Some(code), rest));
        match all.iter_mut().find(|group| code.is_some() && group.0 == code) {
            Some(group) => group.1.push(words),
            None => all.push((code, vec![words])),
        }
    }
    let group = |(code, texts): &(Option<Code>, Vec<&str>)| {
        json!({
            "code": code.map(|c| c.id()), "title": code.map(|c| c.title()), "explanation": code.map(|c| c.text()), "texts": texts,
        })
    };
    all.iter().map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_one_kind_stand_together() {
        let found = groups(&["W003 fast", "as it was written before", "W003 faster"].map(String::from));
        assert_eq!(found.as_array().map(Vec::len), Some(2));
        assert_eq!(found[0]["texts"], json!(["fast", "faster"]));
        assert_eq!(found[0]["title"], Code::FastFlow.title());
        assert_eq!(
            (&found[1]["code"], &found[1]["texts"][0]),
            (&Value::Null, &json!("as it was written before"))
        );
    }
}

//! As much of JSON Schema (draft 2020-12) as the schema of scenes uses; a keyword beyond that is an error of the test.

use serde_json::Value;

/// Whether the value is valid, or else the error.
pub(super) fn validate(root: &Value, schema: &Value, value: &Value) -> Result<(), String> {
    let fail = |what: &str| Err(format!("{value}: {what} {schema}"));
    let number = |bound: &Value| value.as_f64().zip(bound.as_f64());
    let holds = |result: Result<(), String>| result.is_ok();
    for (keyword, says) in schema.as_object().expect("a schema is an object") {
        let ok = match keyword.as_str() {
            // What is said to people, and to the editor.
            "$schema" | "$defs" | "title" | "description" | "default" => true,
            "$ref" => {
                let place = says.as_str().and_then(|place| place.strip_prefix('#')).expect("a place in this document");
                validate(root, root.pointer(place).expect("a place that exists"), value)?;
                true
            }
            "type" => match says.as_str().expect("one type") {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "number" => value.is_number(),
                "string" => value.is_string(),
                other => panic!("the type {other}"),
            },
            "const" => says == value,
            "enum" => says.as_array().expect("a list").contains(value),
            "required" => value.as_object().is_none_or(|object| {
                says.as_array().expect("a list").iter().all(|key| object.contains_key(key.as_str().expect("a name")))
            }),
            "dependentRequired" => value.as_object().is_none_or(|object| {
                let needs = says.as_object().expect("a table").iter().filter(|(key, _)| object.contains_key(*key));
                let names = |list: &Value| list.as_array().expect("a list").clone();
                needs.flat_map(|(_, list)| names(list)).all(|key| object.contains_key(key.as_str().expect("a name")))
            }),
            "properties" => {
                for (key, inner) in value.as_object().into_iter().flatten() {
                    says.get(key).map_or(Ok(()), |schema| validate(root, schema, inner))?;
                }
                true
            }
            "additionalProperties" => {
                let known = |key: &str| schema.get("properties").is_some_and(|known| known.get(key).is_some());
                let others = value.as_object().into_iter().flatten().filter(|(key, _)| !known(key));
                match says.as_bool() {
                    Some(allowed) => allowed || others.count() == 0,
                    None => {
                        others.map(|(_, inner)| inner).try_for_each(|inner| validate(root, says, inner))?;
                        true
                    }
                }
            }
            "if" => {
                let branch = if holds(validate(root, says, value)) { "then" } else { "else" };
                validate(root, &schema[branch], value)?;
                true
            }
            "then" | "else" => true,
            "items" => {
                value.as_array().into_iter().flatten().try_for_each(|item| validate(root, says, item))?;
                true
            }
            "minItems" => value.as_array().is_none_or(|list| list.len() as u64 >= says.as_u64().expect("a count")),
            "maxItems" => value.as_array().is_none_or(|list| list.len() as u64 <= says.as_u64().expect("a count")),
            "minimum" => number(says).is_none_or(|(value, least)| value >= least),
            "maximum" => number(says).is_none_or(|(value, most)| value <= most),
            "exclusiveMinimum" => number(says).is_none_or(|(value, bound)| value > bound),
            "oneOf" | "anyOf" => {
                let all = says.as_array().expect("a list");
                let valid = all.iter().filter(|schema| holds(validate(root, schema, value))).count();
                if keyword == "oneOf" { valid == 1 } else { valid > 0 }
            }
            other => panic!("the keyword {other}"),
        };
        if !ok {
            return fail(keyword);
        }
    }
    Ok(())
}

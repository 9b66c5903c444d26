//! Lists of an earlier version. Schema 1 had an object for each subject, with its settings and
//! results.

use serde::de::Error;
use serde_json::{Map, Value, json};

/// Returns the list that says the same in schema 2.
pub(super) fn upgraded(mut file: Value) -> Result<Value, serde_json::Error> {
    let unshared = file.as_object_mut().and_then(|file| file.remove("unshared"));
    let objects = match file.get_mut("comparisons").map(Value::take) {
        Some(Value::Array(comparisons)) => comparisons,
        _ => [Some(file.clone()), unshared].into_iter().flatten().collect(),
    };
    let mut results = Vec::new();
    for object in objects.iter().filter(|object| !object.is_null()) {
        let Some(old) = object.get("results").and_then(Value::as_array) else {
            return Err(serde_json::Error::missing_field("results"));
        };
        for result in old {
            results.push(record(object, result)?);
        }
    }
    let mut list = json!({ "schema": super::SCHEMA, "results": results });
    // Earlier versions wrote fewer keys. The changes are left out: they can be computed again.
    let first = objects.first().unwrap_or(&Value::Null);
    for key in ["seed", "precision_goal", "machine", "noise", "sharing_speedup"] {
        if !first[key].is_null() {
            list[key] = first[key].clone();
        }
    }
    if let Some(not_measured) = file.get("not_measured") {
        list["not_measured"] = not_measured.clone();
    }
    Ok(list)
}

/// Returns one record from the settings of its object and its own keys.
fn record(object: &Value, result: &Value) -> Result<Value, serde_json::Error> {
    let keys = |value: &Value| value.as_object().cloned().unwrap_or_default();
    let mut record: Map<String, Value> = keys(object);
    for other in ["machine", "noise", "results", "changes"] {
        record.remove(other);
    }
    let reference_digest = record.remove("digest").unwrap_or_default();
    record.insert("reference_digest".to_owned(), reference_digest);
    let disturbed = object["noise"]["disturbed"].as_bool().unwrap_or_default();
    record.insert("disturbed".to_owned(), disturbed.into());
    let accel = match &object["search"] {
        Value::Null => return Err(serde_json::Error::missing_field("search")),
        search if search == "exhaustive" => "none".into(),
        search => search.clone(),
    };
    record.insert("accel".to_owned(), accel);
    record.extend(keys(result));
    let starts_threads = match result["threads_start"].as_str() {
        Some("never") => "none",
        Some("prepare") => "pool",
        Some("render") => "per-render",
        other => other.unwrap_or_default(),
    };
    record.insert("starts_threads".to_owned(), starts_threads.into());
    // Unknown lists were null.
    let list = |list: &Value| if list.is_null() { json!([]) } else { list.clone() };
    record.insert("cpu_samples_ns".to_owned(), list(&result["cpu_samples_ns"]));
    let cold = &result["one_shot"];
    record.insert("cold_ns".to_owned(), cold["median_ns"].clone());
    record.insert("cold_speedup".to_owned(), cold["speedup"].clone());
    record.insert("cold_samples_ns".to_owned(), list(&cold["samples_ns"]));
    Ok(Value::Object(record))
}

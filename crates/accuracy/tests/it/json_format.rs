//! The JSON format of cases and outcomes: what is accepted, what is rejected, and the errors.

use crate::written;
use rayweave_accuracy::{Expect, HardCase, Outcome, Primitive, json_lines};

const PLANE: &str = r#""primitive":{"kind":"plane","point":[0,0,1],"normal":[0.0,0.0,1.0]}"#;
const RAY: &str = r#""ray":{"origin":[0,0,0],"direction":[0,0,1]}"#;

fn case(text: &str) -> Result<HardCase, String> {
    json_lines::read(text.as_bytes())
        .map(|mut cases| cases.remove(0))
        .map_err(|error| error.to_string())
}

#[test]
fn inputs_are_enough_and_unknown_fields_are_passed_over() {
    let text = format!(r#"{{"family":"f","id":"a",{PLANE},{RAY},"seed":[1,{{}}]}}"#);
    let case = case(&text).expect("a case");
    assert_eq!((case.expect, case.decidable, case.cond, case.margin), (None, false, 0.0, 0.0));
    assert_eq!(
        case.primitive,
        Primitive::Plane { point: [0.0, 0.0, 1.0], normal: [0.0, 0.0, 1.0] }
    );
}

#[test]
fn numbers_are_rounded_to_f32_and_may_be_named() {
    let text = format!(
        r#"{{"family":"f","id":"a",{RAY},"primitive":{{"kind":"sphere",{},"radius":{}}}}}"#,
        r#""center":["NaN","Infinity","-Infinity"]"#, "0.1000000000000001"
    );
    let sphere = |text: &str| match case(text) {
        Ok(HardCase { primitive: Primitive::Sphere { center, radius }, .. }) => (center, radius),
        other => panic!("{other:?}"),
    };
    let (center, radius) = sphere(&text);
    assert!(center[0].is_nan());
    assert_eq!((center[1], center[2], radius), (f32::INFINITY, f32::NEG_INFINITY, 0.1));
    assert_eq!(sphere(&text.replace("0.1000000000000001", "1e39")).1, f32::INFINITY);
    let written = written(&[case(&text).expect("a case")]);
    let expected = r#""center":["NaN","Infinity","-Infinity"],"radius":0.1}"#;
    assert!(written.contains(expected), "{written}");
}

#[test]
fn answers_are_read_in_their_three_forms() {
    let with = |expect: &str| {
        case(&format!(r#"{{"family":"f","id":"a",{PLANE},{RAY},"expect":{expect}}}"#))
            .map(|case| case.expect)
    };
    assert_eq!(with(r#"{"hit":false}"#), Ok(Some(Expect::Miss)));
    let Ok(Some(Expect::MeshHit { t })) = with(r#"{"min_hits":1,"t":"1.50"}"#) else { panic!() };
    assert_eq!(t.to_f64(), 1.5);
    let hit = with(r#"{"hit":true,"t":"1","point":["0","0","1"],"normal":["0","0","1e0"]}"#);
    assert!(hit.is_ok_and(|expect| expect.is_some_and(|expect| expect.is_hit())));
    for (expect, problem) in [
        (r#"{"hit":true}"#, "a hit has `t`, `point` and `normal`"),
        (r#"{"min_hits":2,"t":"1"}"#, "`min_hits` is 1 and has a `t`"),
        ("{}", "`expect` has `hit` or `min_hits`"),
        (r#"{"min_hits":1,"t":"one"}"#, "expected a decimal number like \"0.5\""),
        (r#"{"min_hits":1,"t":"1e99999"}"#, "expected a decimal number like \"0.5\""),
    ] {
        let error = with(expect).expect_err(expect);
        assert!(error.contains(problem), "{error}");
    }
}

#[test]
fn errors_say_which_line_and_what_was_expected() {
    let good = format!(r#"{{"family":"f","id":"a",{PLANE},{RAY}}}"#);
    for (line, problem) in [
        ("{".to_owned(), "EOF while parsing an object"),
        ("[1]".to_owned(), "invalid"),
        (good.replace("plane", "torus"), "unknown variant `torus`, expected one of `plane`"),
        (good.replace("\"id\":\"a\",", ""), "missing field `id`"),
        (good.replace("[0,0,1]}", "[0,0]}"), "expected an array of length 3"),
        (
            good.replace("[0,0,1]}", "[0,0,\"one\"]}"),
            "expected a number, \"NaN\", \"Infinity\" or \"-Infinity\"",
        ),
        (good.replace("[0,0,1]}", "[0,0,null]}"), "expected a number, \"NaN\""),
        (format!("{good} {good}"), "trailing characters"),
    ] {
        let error = case(&format!("{good}\n\n{line}\n")).expect_err(&line);
        assert!(error.starts_with("line 3, column "), "{error}");
        assert!(error.contains(problem) && !error.contains(" at line "), "{error}");
    }
    let error = json_lines::read::<HardCase>(&b"{\"family\":\"\xff\"}"[..])
        .expect_err("not UTF-8")
        .to_string();
    assert!(error.starts_with("line 1: "), "{error}");
}

#[test]
fn outcomes_are_read_as_written() {
    let text = r#"{"id":"a","hit":true,"t":1.5}
{"id":"b","hit":false}
{"id":"c","hit":false,"t":null,"normal":[0,0,1]}
{"id":"d","hit":true,"t":"-Infinity"}
{"id":"e","hit":true,"t":2}
"#;
    let found: Vec<Outcome> = json_lines::read(text.as_bytes()).expect("outcomes");
    let outcome = |id: &str, hit, t| Outcome { id: id.into(), hit, t };
    let expected = [
        outcome("a", true, Some(1.5)),
        outcome("b", false, None),
        outcome("c", false, None),
        outcome("d", true, Some(f64::NEG_INFINITY)),
        outcome("e", true, Some(2.0)),
    ];
    assert_eq!(found, expected);
    let nan = outcome("f", true, Some(f64::NAN));
    let written = written(&[expected[0].clone(), expected[1].clone(), nan]);
    let lines: Vec<&str> = text.lines().take(2).collect();
    assert_eq!(
        written,
        format!("{}\n{{\"id\":\"f\",\"hit\":true,\"t\":\"NaN\"}}\n", lines.join("\n"))
    );
    let error = json_lines::read::<Outcome>(&b"{\"id\":\"a\",\"hit\":true,\"t\":\"far\"}"[..])
        .expect_err("no number")
        .to_string();
    assert!(error.contains("expected a number, \"NaN\""), "{error}");
}

//! The steps of CONTRIBUTING.md, "How to add a strategy", as they stand there, and a machine whose
//! C compiler has no OpenMP.

use crate::workspace_copy::{WorkspaceCopy, blocks, repository};
use std::fs;
use std::path::Path;

const STRATEGY: &str = "dealt-rows";

/// Returns the output of the copy's `rayweave`, which has to succeed.
fn run(copy: &WorkspaceCopy, environment: &[(&str, &Path)], arguments: &[&str]) -> String {
    let output = copy.rayweave(environment, arguments);
    let (out, err) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{arguments:?}: {out}{err}");
    assert_eq!(err, "", "{arguments:?}");
    out.into_owned()
}

/// Catches a contract that changed under its description, and any place besides the registry that
/// has to know a strategy.
pub(crate) fn the_steps_add_a_strategy(copy: &WorkspaceCopy) {
    let text = fs::read_to_string(repository().join("CONTRIBUTING.md")).expect("the document");
    let ([manifest, dependency, member_dependency], [source, registry_line]) =
        (&blocks(&text, "toml")[..], &blocks(&text, "rust")[..])
    else {
        panic!("three blocks of TOML and two of Rust");
    };

    let strategy = copy.path("crates/strategies").join(STRATEGY);
    fs::create_dir_all(strategy.join("src")).expect("a folder");
    fs::write(strategy.join("Cargo.toml"), manifest).expect("written");
    fs::write(strategy.join("src/lib.rs"), source).expect("written");
    let insert = |file, after: &str, line: &str| {
        copy.replace(file, after, &format!("{after}\n{}", line.trim()));
    };
    insert("Cargo.toml", "# One line a strategy.", dependency);
    insert("crates/registry/Cargo.toml", "[dependencies]", member_dependency);
    // At the end of the slice.
    copy.replace("crates/registry/src/lib.rs", "\n];", &format!("\n{registry_line}];"));

    let rayweave = |arguments: &[&str]| run(copy, &[], arguments);
    assert!(rayweave(&["strategies"]).lines().any(|line| line.starts_with(STRATEGY)));
    let check = rayweave(&["check", "--strategy", STRATEGY, "--size", "64x48"]);
    assert!(check.contains("all identical"), "{check}");
}

/// Asserts that a build by a compiler that knows no OpenMP has the other strategies.
#[cfg(unix)]
pub(crate) fn without_openmp(copy: &WorkspaceCopy) {
    use std::os::unix::fs::PermissionsExt;
    let compiler = copy.path("cc-without-openmp");
    let script =
        "#!/bin/sh\nfor word; do [ \"$word\" != -fopenmp ] || exit 1; done\nexec cc \"$@\"\n";
    fs::write(&compiler, script).expect("written");
    fs::set_permissions(&compiler, fs::Permissions::from_mode(0o755)).expect("permitted");

    let rayweave = |arguments: &[&str]| run(copy, &[("CC", &compiler)], arguments);
    let list = rayweave(&["strategies"]);
    let reason = format!(
        "built without OpenMP: the C compiler {} does not know -fopenmp",
        compiler.display()
    );
    assert_eq!(list.matches(&reason).count(), 3, "{list}");
    let named = ["render", "--strategy", "openmp-guided"];
    let refused = copy.rayweave(&[("CC", &compiler)], &named);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&refused.stderr).contains(&format!("unavailable here: {reason}"))
    );

    let check = rayweave(&["check", "--size", "4x3", "--threads", "2", "--tile", "2"]);
    assert!(check.contains("all identical"), "{check}");
    let left_out =
        "left out because unavailable here: openmp-static, openmp-dynamic, openmp-guided ";
    assert!(check.contains(left_out), "{check}");
}

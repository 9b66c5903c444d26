//! Compiles `src/loops.c` where the C compiler and its linker know OpenMP. Elsewhere the crate is
//! built without, and says why.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const LOOPS: &str = "src/loops.c";
const HEADER: &str = "src/loops.h";
const PROBE: &str = "src/probe.c";
const FLAG: &str = "-fopenmp";

/// The libraries of OpenMP for a program that another compiler links: gcc's, and clang's.
const LIBRARIES: [&str; 2] = ["gomp", "omp"];

fn main() {
    for file in [LOOPS, HEADER, PROBE] {
        println!("cargo::rerun-if-changed={file}");
    }
    println!("cargo::rustc-check-cfg=cfg(openmp)");
    match compile() {
        Ok(()) => println!("cargo::rustc-cfg=openmp"),
        Err(missing) => println!(
            "cargo::rustc-env=WITHOUT_OPENMP=built without OpenMP: {missing}; \
             install gcc, or clang with libomp, and build again"
        ),
    }
}

fn compile() -> Result<(), String> {
    let mut build = cc::Build::new();
    // A missing OpenMP is no error of the build: the strategies report it to a user who asks for
    // them.
    build.cargo_warnings(false).file(LOOPS).flag(FLAG);
    let compiler = build.try_get_compiler().map_err(|_| "there is no C compiler".to_owned())?;
    let name = compiler.path().display();
    if !runs(Command::new(compiler.path()).arg("--version")) {
        return Err(format!("there is no C compiler ({name} does not run)"));
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo names no OUT_DIR")?);
    let link = |arguments: &[String]| {
        let mut command = compiler.to_command();
        runs(command.args([LOOPS, PROBE]).args(arguments).arg("-o").arg(folder.join("probe")))
    };
    if !link(&[]) {
        return Err(format!(
            "the C compiler {name} does not know {FLAG}, or has no library for it"
        ));
    }
    // Rust's linker does not know the flag, and has to be told the library.
    let library = LIBRARIES.into_iter().find(|library| link(&[format!("-l{library}")]));
    let library = library
        .ok_or_else(|| format!("the OpenMP library of the C compiler {name} is not known"))?;
    build.try_compile("rayweave_openmp_loops").map_err(|e| format!("{name}: {e}"))?;
    if let Some(folder) = folder_of(library, compiler.path()) {
        println!("cargo::rustc-link-search=native={}", folder.display());
    }
    println!("cargo::rustc-link-lib={library}");
    Ok(())
}

/// Runs a command quietly, and returns true if it succeeds.
fn runs(command: &mut Command) -> bool {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Returns the place where the compiler has this library, if it says so.
fn folder_of(library: &str, compiler: &Path) -> Option<PathBuf> {
    let file = format!("{}{library}{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    let output = Command::new(compiler).arg(format!("-print-file-name={file}")).output().ok()?;
    let path = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim());
    // If the compiler does not know, it prints the name alone.
    path.parent().filter(|folder| folder.is_absolute()).map(Path::to_owned)
}

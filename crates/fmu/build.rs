//! Link options: libraries in the folder of the FMU's library are found first, also those that others need, and there are no symbols for
//! debuggers.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for option in ["-rpath,$ORIGIN", "--disable-new-dtags", "--strip-debug"] {
        println!("cargo::rustc-link-arg-cdylib=-Wl,{option}");
    }
}

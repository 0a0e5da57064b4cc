// SPDX-License-Identifier: MIT
//! The examples run. `cargo test` without a choice of tests builds them before this.

use std::path::{Path, PathBuf};
use std::process::Command;

fn run(name: &str, arguments: &[&str]) -> String {
    let own = std::env::current_exe().expect("a test knows where it is");
    let folder = own.parent().and_then(Path::parent).expect("target/PROFILE/deps").join("examples");
    let output = Command::new(folder.join(name)).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{name}, in {}: {error}", folder.display()));
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn hello_says_what_it_says_in_c() {
    assert_eq!(run("hello", &[]), "inserted: 4\nmoved: 8\nremoved: inf\n");
}

#[test]
fn game_tells_its_rates() {
    let text = run("game", &["300", "3"]);
    assert!(text.starts_with("300 agents, 3 frames"), "{text}");
    let percent = text.lines().last().and_then(|line| line.split(' ').next()).and_then(|word| word.parse().ok());
    assert!(percent.is_some_and(|percent: f64| percent > 30.0 && percent < 100.0), "{text}");
}

#[test]
fn picture_is_a_picture() {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("picture.png");
    run("picture", &[path.to_str().expect("a path of letters"), "320"]);
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("the picture is there"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("pixels");
    assert_eq!((info.width, info.height), (320, 180));
    let colours: std::collections::HashSet<&[u8]> = bytes.chunks_exact(3).collect();
    assert!(colours.len() > 1000, "only {} colours", colours.len());
}

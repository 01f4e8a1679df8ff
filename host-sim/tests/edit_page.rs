//! The page of `world edit` in a real browser: an edge hidden by hand is hidden from the robot.

mod browser;

use browser::Browser;
use edgeloc_sim::world::viewpoints::file;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// `edgeloc` in a folder of its own.
fn edgeloc(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edgeloc"));
    command.current_dir(folder).args(arguments).env("NO_COLOR", "1").env_remove("RUST_LOG");
    command
}

/// Standard output of a command that must succeed.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = edgeloc(folder, arguments).output().expect("the binary starts");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The editor, serving until it is dropped.
struct Editor {
    process: Child,
    address: String,
}

impl Editor {
    fn start(folder: &Path) -> Self {
        let mut process = edgeloc(folder, &["world", "edit", "office-3.edgeworld", "--no-browser"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the binary starts");
        let mut address = String::new();
        let output = process.stdout.take().expect("a pipe");
        BufReader::new(output).read_line(&mut address).expect("the editor prints its address");
        Self { process, address: address.trim().to_owned() }
    }

    /// The first line of the answer to a request for `path` in the name of `host`.
    fn answer(&self, host: &str, path: &str) -> String {
        let own = self.address.trim_start_matches("http://").split('/').next().expect("a host");
        let mut stream = TcpStream::connect(own).expect("the editor listens");
        let host = if host.is_empty() { own } else { host };
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").expect("the editor reads");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("the editor answers");
        answer.lines().next().unwrap_or_default().to_owned()
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// An office with twelve reference viewpoints.
fn office() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    done(folder.path(), &["world", "generate", "--seed", "3", "-o", "office-3.edgeworld"]);
    done(folder.path(), &["world", "visibility", "office-3.edgeworld", "--viewpoints", "12"]);
    folder
}

/// The scenario of the trials: few nodes, no noise, and what is visible from the file.
const SCENARIO: [&str; 7] =
    ["smoke", "--nodes", "4", "--world", "office-3.edgeworld", "--set", "world.visibility=office-3.views"];

/// Settings that switch off every source of uncertainty.
fn noise_free(folder: &Path) -> Vec<String> {
    let config = done(folder, &["run", "smoke", "--print-config"]).parse::<toml::Table>().expect("TOML");
    let sources = config["uncertainty"].as_table().expect("a table");
    let switched = sources.iter().filter(|(_, source)| source.get("enabled").is_some());
    switched.flat_map(|(key, _)| ["--set".to_owned(), format!("uncertainty.{key}.enabled=false")]).collect()
}

/// How many segments the robot sees in the first look of a trial that starts at `place`.
fn seen_segments(folder: &Path, place: &str) -> u64 {
    let noise_free = noise_free(folder);
    let settings = noise_free.iter().map(String::as_str).collect::<Vec<_>>();
    let at = ["--at", place, "--heading-deg", "0", "--format", "json", "--out", "drawings"];
    let attempt = done(folder, &[&["locate"][..], &SCENARIO, &settings, &at].concat());
    let attempt = serde_json::from_str::<Value>(&attempt).expect("JSON");
    attempt["looks"][0]["seen_segments"].as_u64().expect("a count")
}

/// The middle of a segment as the page shows it, in pixels of the page.
const MIDDLE: &str = "([, x1, y1, x2, y2]) => { const box = view.getBoundingClientRect(); \
    const scale = view.clientWidth / world.size_px[0]; \
    return [box.left + view.clientLeft + (x1 + x2) / 2 * scale, box.top + view.clientTop + (y1 + y2) / 2 * scale]; }";

/// A visible segment ahead, well inside the robot's image, that a click in its middle takes.
const CLICKABLE: &str = "seen.segments.find(s => s[5] && [s[1], s[3]].every(x => Math.abs(x - 640) < 250) \
    && [s[2], s[4]].every(y => Math.abs(y - 400) < 200) && Math.hypot(s[1] - s[3], s[2] - s[4]) > 30 \
    && segmentAt({ x: (s[1] + s[3]) / 2, y: (s[2] + s[4]) / 2 }) === s)";

fn pair(value: &Value) -> (f64, f64) {
    (value[0].as_f64().expect("a number"), value[1].as_f64().expect("a number"))
}

#[test]
fn an_edge_hidden_by_hand_is_saved_and_hidden_from_the_robot() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = office();
    let (path, views) = (folder.path(), folder.path().join("office-3.views"));
    let viewpoint = file::load(&views).expect("a sound file").viewpoints()[0].clone();
    let place = format!("{},{}", viewpoint.position.x, viewpoint.position.y);
    let seen_before = seen_segments(path, &place);
    let run = ["--trials", "1", "--format", "json"];
    done(path, &[&["run"][..], &SCENARIO, &run].concat());
    let replay = ["replay", "runs/latest", "--trial", "0", "--out", "drawings"];
    done(path, &replay);

    let editor = Editor::start(path);
    browser.call("Page.navigate", &json!({ "url": format!("{}#viewpoint=0&heading=0", editor.address) }));
    browser.wait_until("seen.segments.length > 0 && get('state').textContent.endsWith(' saved')");

    // Hide one edge by a click.
    let edge = browser.evaluate(&format!("{CLICKABLE}[0]")).as_u64().expect("an edge ahead") as u32;
    let middle = pair(&browser.evaluate(&format!("({MIDDLE})({CLICKABLE})")));
    browser.drag(middle, middle);
    browser.wait_until(&format!("seen.segments.find(s => s[0] === {edge})[5] === 0"));
    browser.wait_until("get('state').textContent.endsWith('not saved') && !get('save').disabled");

    // Hide a whole rectangle, undo that, and redo and undo it once more.
    let visible_count = "seen.segments.filter(s => s[5]).length";
    let one_hidden = browser.evaluate(visible_count).as_u64().expect("a count");
    browser.press("h", 0);
    let corner = |x: &str, y: &str| format!("({MIDDLE})([0, {x}, {y}, {x}, {y}])");
    let (from, to) = (browser.evaluate(&corner("300", "100")), browser.evaluate(&corner("1000", "700")));
    browser.drag(pair(&from), pair(&to));
    browser.wait_until(&format!("{visible_count} < {one_hidden} - 3"));
    browser.wait_until("get('hint').textContent.endsWith('edges hidden')");
    for (key, modifiers) in [("z", 2), ("z", 2 + 8), ("z", 2)] {
        let is_undo = modifiers == 2;
        browser.press(key, modifiers);
        browser.wait_until(&format!("({visible_count} === {one_hidden}) === {is_undo}"));
        browser.wait_until(&format!("get('hint').textContent === '{}'", if is_undo { "Undone" } else { "Done again" }));
    }

    // Leaving without saving is asked about; the server keeps the edit all the same.
    browser.evaluate("window.isLeft = true");
    browser.send("Page.reload", &json!({}));
    assert_eq!(browser.wait_for_event("Page.javascriptDialogOpening")["type"], "beforeunload");
    browser.call("Page.handleJavaScriptDialog", &json!({ "accept": true }));
    browser
        .wait_until(&format!("!window.isLeft && seen.segments.find(s => s[0] === {edge})[5] === 0 && seen.can_redo"));
    assert!(file::load(&views).expect("a sound file").viewpoints()[0].visible.contains(edge), "not saved yet");

    // Save, and reload without a question.
    browser.press("s", 2);
    browser.wait_until("get('state').textContent.endsWith('\\u00b7 saved') && get('save').disabled");
    let saved = file::load(&views).expect("a sound file");
    assert!(!saved.viewpoints()[0].visible.contains(edge));
    assert_eq!(saved.viewpoints()[0].visible.len() + 1, viewpoint.visible.len(), "that edge alone");
    browser.evaluate("window.isLeft = true");
    browser.call("Page.reload", &json!({}));
    browser
        .wait_until(&format!("!window.isLeft && seen.is_saved && seen.segments.find(s => s[0] === {edge})[5] === 0"));
    assert!(browser.evaluate("document.getElementById('hint').textContent.trim()") == "", "nothing to complain of");

    assert_eq!(seen_segments(path, &place) + 1, seen_before, "the robot misses edge {edge}");
    let replayed = edgeloc(path, &replay).output().expect("the binary starts");
    let words = String::from_utf8_lossy(&replayed.stderr).replace(['\n', '│'], " ");
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(!replayed.status.success() && words.contains("has changed since the run"), "{words}");
}

#[test]
fn the_editor_answers_nobody_without_its_token_or_by_another_name() {
    let folder = office();
    let editor = Editor::start(folder.path());
    let page = &editor.address[editor.address.rfind(':').expect("a port")..];
    let page = &page[page.find('/').expect("a path")..];
    assert_eq!(editor.answer("", page), "HTTP/1.1 200 OK");
    assert_eq!(editor.answer("", "/"), "HTTP/1.1 403 Forbidden");
    assert_eq!(editor.answer("rebound.example", page), "HTTP/1.1 403 Forbidden");
    assert!(page.len() >= 34, "128 random bits: {page}");
}

//! Serves the editor's page to this machine alone.
//!
//! Three locks: it listens on the loopback address; every address begins with a random word, so that no other program or
//! page can guess one; and the request must name this very host, so that a foreign name made to point here (DNS
//! rebinding) is refused, as is a request that another page makes.

use super::editor::{Editor, Failure};
use super::http::{self, Answer, Request};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Longest wait for the rest of a request: browsers open connections that they may not use.
const PATIENCE: Duration = Duration::from_secs(20);

/// The most connections at a time.
const MAX_CONNECTIONS: usize = 64;

/// A port of this machine, not yet served.
#[derive(Debug)]
pub(super) struct Server {
    listener: TcpListener,
    lock: Lock,
}

/// What a request must know.
#[derive(Debug, Clone)]
struct Lock {
    port: u16,
    token: String,
}

impl Server {
    /// Takes a port, any free one for 0.
    pub(super) fn bind(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let port = listener.local_addr()?.port();
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        let token = random.iter().fold(String::new(), |mut token, byte| {
            let _ = write!(token, "{byte:02x}");
            token
        });
        Ok(Self { listener, lock: Lock { port, token } })
    }

    /// Where the page is.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.lock.port, self.lock.token)
    }

    /// Answers until the program is stopped.
    pub(super) fn serve(&self, editor: Editor) {
        let editor = Arc::new(Mutex::new(editor));
        let connections = Arc::new(AtomicUsize::new(0));
        for stream in self.listener.incoming().flatten() {
            let (lock, editor, connections) = (self.lock.clone(), editor.clone(), connections.clone());
            if connections.fetch_add(1, Ordering::Relaxed) < MAX_CONNECTIONS {
                std::thread::spawn(move || {
                    // A browser that goes away is no concern of ours.
                    let _ = converse(stream, &lock, &editor);
                    connections.fetch_sub(1, Ordering::Relaxed);
                });
            } else {
                connections.fetch_sub(1, Ordering::Relaxed);
            }
        }
    }
}

fn converse(mut stream: TcpStream, lock: &Lock, editor: &Mutex<Editor>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let answer = match http::read(&mut stream) {
        Some(request) => lock.answer(&request, editor),
        None => text("400 Bad Request", "this is no request the editor understands"),
    };
    http::write(&mut stream, &answer)
}

impl Lock {
    fn answer(&self, request: &Request, editor: &Mutex<Editor>) -> Answer {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        if !hosts.contains(&request.host) {
            return text("403 Forbidden", "the editor answers to the address it printed alone");
        }
        if request.origin.as_ref().is_some_and(|origin| *origin != format!("http://{}", request.host)) {
            return text("403 Forbidden", "the editor answers to its own page alone");
        }
        let path = request.target.strip_prefix('/').and_then(|path| path.split_once('/'));
        match path {
            Some((token, rest)) if is_same(token, &self.token) => {
                // The editor stays sound when an answer panicked: each change is made in one step.
                let mut editor = editor.lock().unwrap_or_else(PoisonError::into_inner);
                route(&request.method, rest, &request.body, &mut editor)
            }
            _ => text("403 Forbidden", "open the address that `edgeloc world edit` printed, the whole of it"),
        }
    }
}

/// Compares in the same time wherever they differ.
fn is_same(given: &str, token: &str) -> bool {
    let difference = given.bytes().zip(token.bytes()).fold(0, |sum, (a, b)| sum | (a ^ b));
    given.len() == token.len() && difference == 0
}

fn route(method: &str, target: &str, body: &[u8], editor: &mut Editor) -> Answer {
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let query: BTreeMap<&str, &str> = query.split('&').filter_map(|pair| pair.split_once('=')).collect();
    let number = |name: &str| query.get(name).and_then(|value| value.parse::<f32>().ok());
    let viewpoint = query.get("viewpoint").and_then(|value| value.parse::<usize>().ok()).unwrap_or(usize::MAX);
    let file = |content_type, text: &str| Answer { status: "200 OK", content_type, body: text.as_bytes().to_vec() };
    match (method, path) {
        ("GET", "") => file("text/html; charset=utf-8", include_str!("page.html")),
        ("GET", "page.css") => file("text/css; charset=utf-8", include_str!("page.css")),
        ("GET", "page.js") => file("text/javascript; charset=utf-8", include_str!("page.js")),
        ("GET", "world") => json(Ok(editor.world())),
        ("GET", "view") => json(editor.view(viewpoint, number("heading").unwrap_or(0.0))),
        ("POST", "show" | "hide") => match serde_json::from_slice::<Vec<u32>>(body) {
            Ok(edges) => json(editor.set_visible(viewpoint, &edges, path == "show")),
            Err(_) => text("400 Bad Request", "the body is a list of the numbers of edges"),
        },
        ("POST", "undo") => json(editor.undo()),
        ("POST", "redo") => json(editor.redo()),
        ("POST", "save") => json(editor.save(query.contains_key("overwrite"))),
        _ => text("404 Not Found", "there is no such page"),
    }
}

fn json(answer: Result<impl serde::Serialize, Failure>) -> Answer {
    match answer {
        Ok(value) => Answer {
            status: "200 OK",
            content_type: "application/json",
            body: serde_json::to_vec(&value).unwrap_or_default(),
        },
        Err(failure @ Failure::NotThere(_)) => text("404 Not Found", &failure.to_string()),
        Err(failure @ Failure::ChangedOnDisk(_)) => text("409 Conflict", &failure.to_string()),
        Err(failure @ Failure::NotSaved(_)) => text("500 Internal Server Error", &failure.to_string()),
    }
}

fn text(status: &'static str, sentence: &str) -> Answer {
    Answer { status, content_type: "text/plain; charset=utf-8", body: sentence.as_bytes().to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::world::edit::editor::sample;

    const TOKEN: &str = "0123456789abcdef0123456789abcdef";

    fn status(method: &str, host: &str, origin: Option<&str>, target: &str) -> &'static str {
        let lock = Lock { port: 8000, token: TOKEN.to_owned() };
        let folder = tempfile::tempdir().expect("a temporary folder");
        let editor = Mutex::new(sample(folder.path()));
        let request = Request {
            method: method.to_owned(),
            target: target.to_owned(),
            host: host.to_owned(),
            origin: origin.map(str::to_owned),
            body: b"[0]".to_vec(),
        };
        lock.answer(&request, &editor).status
    }

    #[test]
    fn only_this_host_with_the_token_is_answered() {
        let page = format!("/{TOKEN}/");
        let hide = format!("/{TOKEN}/hide?viewpoint=0");
        assert_eq!(status("GET", "127.0.0.1:8000", None, &page), "200 OK");
        assert_eq!(status("GET", "localhost:8000", None, &page), "200 OK");
        assert_eq!(status("POST", "127.0.0.1:8000", Some("http://127.0.0.1:8000"), &hide), "200 OK");
        for host in ["127.0.0.1", "127.0.0.1:8001", "evil.example:8000", "127.0.0.1:8000.evil.example", ""] {
            assert_eq!(status("GET", host, None, &page), "403 Forbidden", "{host}");
        }
        for origin in ["http://evil.example", "null", "http://127.0.0.1:8001"] {
            assert_eq!(status("POST", "127.0.0.1:8000", Some(origin), &hide), "403 Forbidden", "{origin}");
        }
        for target in ["/", "", "//", "/world", &page[..TOKEN.len()], "/0123456789abcdef0123456789abcdee/", "/../x/"] {
            assert_eq!(status("GET", "127.0.0.1:8000", None, target), "403 Forbidden", "{target}");
        }
    }

    #[test]
    fn what_is_not_there_is_said_and_changes_need_a_post() {
        let at = |rest: &str| format!("/{TOKEN}/{rest}");
        let own = "127.0.0.1:8000";
        assert_eq!(status("GET", own, None, &at("hide?viewpoint=0")), "404 Not Found");
        assert_eq!(status("POST", own, None, &at("hide?viewpoint=9")), "404 Not Found");
        assert_eq!(status("POST", own, None, &at("hide")), "404 Not Found");
        assert_eq!(status("GET", own, None, &at("view?viewpoint=0&heading=NaN")), "404 Not Found");
        assert_eq!(status("GET", own, None, &at("../../etc/passwd")), "404 Not Found");
        assert_eq!(status("POST", own, None, &at("undo")), "404 Not Found");
    }
}

//! A headless Chromium, spoken to through its DevTools protocol.

use std::fs;
use std::io::Read as _;
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket, client};

/// How long anything may take; a loaded machine needs some seconds to start a browser.
const PATIENCE: Duration = Duration::from_secs(90);

/// A browser of its own for one test; it ends with it.
pub struct Browser {
    child: Child,
    _profile: TempDir,
    socket: WebSocket<TcpStream>,
    session: String,
    number: u64,
    /// What the page reported, in order.
    events: Vec<Value>,
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Browser {
    /// Starts one with an empty page.
    pub fn start() -> Self {
        let profile = tempfile::tempdir().expect("a folder for the profile");
        let mut command = Command::new("chromium");
        command
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--remote-debugging-port=0",
            ])
            .args([
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        let child = command.spawn().unwrap_or_else(|e| {
            panic!("no chromium ({e}): the pages are tested in a real browser; `scripts/install chromium fonts-dejavu-core` installs it, `scripts/test` does so by itself")
        });
        let address = address(profile.path());
        let stream =
            TcpStream::connect(address.split('/').next().expect("host and port")).expect("the browser listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a time limit");
        let (socket, _) = client(format!("ws://{address}"), stream).expect("the browser speaks");
        let mut browser = Self {
            child,
            _profile: profile,
            socket,
            session: String::new(),
            number: 0,
            events: vec![],
        };
        let target = browser.call("Target.createTarget", json!({"url": "about:blank"}));
        let session = browser.call(
            "Target.attachToTarget",
            json!({"targetId": target["targetId"], "flatten": true}),
        );
        browser.session = session["sessionId"].as_str().expect("a session").to_string();
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser
    }

    /// One command and its answer.
    pub fn call(&mut self, method: &str, params: Value) -> Value {
        self.number += 1;
        let mut command = json!({"id": self.number, "method": method, "params": params});
        if !self.session.is_empty() {
            command["sessionId"] = self.session.as_str().into();
        }
        self.socket
            .send(Message::text(command.to_string()))
            .expect("a command is sent");
        loop {
            let message = self.read();
            if message["id"] == self.number {
                assert!(message.get("error").is_none(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
            self.events.push(message);
        }
    }

    fn read(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.socket.read().expect("the browser answers in time") {
                return serde_json::from_str(&text).expect("JSON");
            }
        }
    }

    /// Width of the window [CSS pixels] and scheme of colours for what is opened next.
    pub fn set(&mut self, width: u32, scheme: &str) {
        let metrics = json!({"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500});
        self.call("Emulation.setDeviceMetricsOverride", metrics);
        let features = json!({"features": [{"name": "prefers-color-scheme", "value": scheme}]});
        self.call("Emulation.setEmulatedMedia", features);
    }

    /// Opens a file and waits until the page says that it is ready.
    pub fn open(&mut self, file: &Path) {
        self.events.clear();
        let url = format!("file://{}", file.canonicalize().expect("the page").display());
        self.call("Page.navigate", json!({"url": url}));
        self.until("document.documentElement?.dataset.ready === 'yes'");
    }

    /// Value of an expression in the page.
    pub fn eval(&mut self, expression: &str) -> Value {
        let params = json!({"expression": expression, "returnByValue": true, "awaitPromise": true});
        let answer = self.call("Runtime.evaluate", params);
        assert!(
            answer.get("exceptionDetails").is_none(),
            "{expression}: {}",
            answer["exceptionDetails"]
        );
        answer["result"]["value"].clone()
    }

    /// The number that an expression gives.
    pub fn number(&mut self, expression: &str) -> f64 {
        let value = self.eval(expression);
        value.as_f64().unwrap_or_else(|| panic!("{expression}: {value}"))
    }

    /// The text that an expression gives.
    pub fn text(&mut self, expression: &str) -> String {
        let value = self.eval(expression);
        value
            .as_str()
            .unwrap_or_else(|| panic!("{expression}: {value}"))
            .to_string()
    }

    /// Waits until an expression is true.
    pub fn until(&mut self, expression: &str) {
        let begin = Instant::now();
        while self.eval(expression) != Value::Bool(true) {
            assert!(
                begin.elapsed() < PATIENCE,
                "never true: {expression}; {:?}",
                self.problems()
            );
            sleep(Duration::from_millis(20));
        }
    }

    /// A key pressed and let go, as a person does.
    pub fn press(&mut self, key: &str) {
        let (code, text, number) = match key {
            " " => ("Space", " ", 32),
            "ArrowLeft" => (key, "", 37),
            "ArrowRight" => (key, "", 39),
            "ArrowDown" => (key, "", 40),
            "Escape" => (key, "", 27),
            "Tab" => (key, "", 9),
            "Enter" => (key, "\r", 13),
            other => panic!("no key {other}"),
        };
        for kind in ["keyDown", "keyUp"] {
            let mut event = json!({"type": kind, "key": key, "code": code, "windowsVirtualKeyCode": number});
            if kind == "keyDown" && !text.is_empty() {
                event["text"] = text.into();
            }
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// A click in the middle of an element.
    pub fn click(&mut self, selector: &str, share: (f64, f64)) {
        let expression = format!(
            "(() => {{ const e = document.querySelector({selector:?}); e.scrollIntoView({{block: 'center', behavior: 'instant'}}); \
             const b = e.getBoundingClientRect(); return [b.left + {} * b.width, b.top + {} * b.height]; }})()",
            share.0, share.1
        );
        let at = self.eval(&expression);
        for kind in ["mouseMoved", "mousePressed", "mouseReleased"] {
            let event = json!({"type": kind, "x": at[0], "y": at[1], "button": "left", "clickCount": 1});
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// What went wrong in the page: exceptions, errors and warnings, requests to anything but the page itself.
    pub fn problems(&self) -> Vec<String> {
        let wrong = |event: &Value| -> Option<String> {
            let params = &event["params"];
            match event["method"].as_str()? {
                "Runtime.exceptionThrown" => Some(format!("exception: {}", params["exceptionDetails"])),
                "Runtime.consoleAPICalled" => Some(format!("console: {}", params["args"])),
                "Log.entryAdded" => Some(format!("log: {}", params["entry"]["text"])),
                "Network.requestWillBeSent" => {
                    let url = params["request"]["url"].as_str()?;
                    let own = params["type"] == "Document" && url.starts_with("file:");
                    (!own && !url.starts_with("data:")).then(|| format!("request: {url}"))
                }
                _ => None,
            }
        };
        self.events.iter().filter_map(wrong).collect()
    }
}

/// Host, port and path on which the browser listens, as it writes into its profile.
fn address(profile: &Path) -> String {
    let begin = Instant::now();
    loop {
        let mut text = String::new();
        if let Ok(mut file) = fs::File::open(profile.join("DevToolsActivePort")) {
            let _ = file.read_to_string(&mut text);
        }
        if let Some((port, path)) = text.trim().split_once('\n') {
            return format!("127.0.0.1:{port}{path}");
        }
        assert!(begin.elapsed() < PATIENCE, "chromium did not start");
        sleep(Duration::from_millis(30));
    }
}

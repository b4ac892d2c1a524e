// HTTP client of low CPU use: one keep-alive connection, one request at a time.

import net from "node:net";

const kWait_ms = 70_000; // timeout of a response; a picture may take 60 s

function read_head(buffer) {
  const end = buffer.indexOf("\r\n\r\n");
  if (end < 0) return null;
  const head = buffer.latin1Slice(0, end + 2);
  const status = Number(head.slice(9, 12));
  const length = /\r\ncontent-length: *(\d+)/i.exec(head);
  const without_body = status === 304 || status === 204;
  return {
    status,
    head,
    total: end + 4 + (without_body ? 0 : Number(length?.[1] ?? 0)),
    body_at: end + 4,
    closes: /\r\nconnection: *close/i.test(head),
  };
}

export const header_of = ({ head }, name) => new RegExp(`\\r\\n${name}: *([^\\r]*)`, "i").exec(head)?.[1];

// Client for responses with a Content-Length, not for streams. A response is {status, head, text(), ms, sent,
// first}:
//   ms: since the request was written
//   sent: time of the request by performance.now()
//   first: whether this is the first request on its connection
// A failed request gives {failure, sent, first}. The failure is "refused" (no connection), "unanswered" (the
// connection closed before the response was complete), "silent" (timeout) or "left" (leave() was called).
export class Client {
  #port;
  #address;
  #socket = null;
  #parts = [];
  #size = 0;
  #waiting = null; // {resolve, sent, answer}

  // `address`: local address, undefined for any.
  constructor(port, address = undefined) {
    this.#port = port;
    this.#address = address;
  }

  // Sends a request. Resolves to the response or the failure. `body`: text or a Buffer.
  ask(path, { method = "GET", headers = {}, body = "" } = {}) {
    const lines = Object.entries(headers).map(([name, value]) => `${name}: ${value}\r\n`);
    const length = body.length > 0 ? `Content-Length: ${Buffer.byteLength(body)}\r\n` : "";
    const head = `${method} ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\n${length}${lines.join("")}\r\n`;
    const bytes = typeof body === "string" ? head + body : Buffer.concat([Buffer.from(head), body]);
    return new Promise((resolve) => {
      this.#waiting = {
        resolve,
        sent: null,
        answer: null,
        without_body: method === "HEAD",
        first: this.#socket === null,
      };
      if (this.#socket) this.#write(bytes);
      else this.#connect(bytes);
    });
  }

  get is_connected() {
    return this.#socket !== null;
  }

  // Closes the connection, even during a request.
  leave() {
    this.#end("left");
  }

  #connect(bytes) {
    const socket = net.connect({ port: this.#port, host: "127.0.0.1", localAddress: this.#address, noDelay: true });
    this.#socket = socket;
    let connected = false;
    const end = () => socket === this.#socket && this.#end(connected ? "unanswered" : "refused");
    socket.setTimeout(kWait_ms, () => socket === this.#socket && this.#waiting && this.#end("silent"));
    socket.on("connect", () => {
      connected = true;
      this.#write(bytes);
    });
    socket.on("data", (chunk) => socket === this.#socket && this.#waiting && this.#take(chunk));
    socket.on("error", end);
    socket.on("close", end);
  }

  #write(bytes) {
    this.#waiting.sent = performance.now();
    this.#socket.write(bytes);
  }

  #take(chunk) {
    this.#parts.push(chunk);
    this.#size += chunk.length;
    const waiting = this.#waiting;
    if (!waiting.answer) {
      this.#parts = [Buffer.concat(this.#parts)];
      waiting.answer = read_head(this.#parts[0]);
      if (waiting.answer && waiting.without_body) waiting.answer.total = waiting.answer.body_at;
    }
    if (waiting.answer && this.#size >= waiting.answer.total) this.#finish();
  }

  #finish() {
    const { resolve, sent, answer, first } = this.#waiting;
    const ms = performance.now() - sent;
    const parts = this.#parts; // concatenated on demand, as a large picture takes a while
    this.#waiting = null;
    this.#forget();
    if (answer.closes) this.leave();
    resolve({ ...answer, text: () => Buffer.concat(parts).toString("utf8", answer.body_at), ms, sent, first });
  }

  #end(failure) {
    const waiting = this.#waiting;
    const socket = this.#socket;
    this.#waiting = this.#socket = null;
    this.#forget();
    socket?.destroy();
    waiting?.resolve({ failure, sent: waiting.sent, first: waiting.first });
  }

  #forget() {
    this.#parts = [];
    this.#size = 0;
  }
}

// HTTP client with low CPU use: one keep-alive connection, at most one open request.

import net from "node:net";

const WAIT_MS = 70_000; // response timeout, above the 60 s that an image may take

function readHead(buffer) {
  const end = buffer.indexOf("\r\n\r\n");
  if (end < 0) return null;
  const head = buffer.latin1Slice(0, end + 2);
  const status = Number(head.slice(9, 12));
  const length = /\r\ncontent-length: *(\d+)/i.exec(head);
  const withoutBody = status === 304 || status === 204;
  return {
    status,
    head,
    total: end + 4 + (withoutBody ? 0 : Number(length?.[1] ?? 0)),
    bodyAt: end + 4,
    closes: /\r\nconnection: *close/i.test(head),
  };
}

export const headerOf = ({ head }, name) => new RegExp(`\\r\\n${name}: *([^\\r]*)`, "i").exec(head)?.[1];

// Client for responses with a Content-Length, not for streams. A response is {status, head, text(), ms, sent,
// first}:
//   ms: milliseconds from the write of the request to the complete response
//   sent: performance.now() when the request was written
//   first: true if the request is the first on its connection
// The result of a failed request is {failure, sent, first}. `failure` is
//   "refused": no connection
//   "unanswered": the connection closed before the response was complete
//   "silent": timeout
//   "left": leave() was called
export class Client {
  #port;
  #address;
  #socket = null;
  #parts = [];
  #size = 0;
  #waiting = null; // {resolve, sent, answer}

  // `address`: local IP address, or undefined for any.
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
        withoutBody: method === "HEAD",
        first: this.#socket === null,
      };
      if (this.#socket) this.#write(bytes);
      else this.#connect(bytes);
    });
  }

  get isConnected() {
    return this.#socket !== null;
  }

  // Closes the connection. An open request resolves to the failure "left".
  leave() {
    this.#end("left");
  }

  #connect(bytes) {
    const socket = net.connect({ port: this.#port, host: "127.0.0.1", localAddress: this.#address, noDelay: true });
    this.#socket = socket;
    let connected = false;
    const end = () => socket === this.#socket && this.#end(connected ? "unanswered" : "refused");
    socket.setTimeout(WAIT_MS, () => socket === this.#socket && this.#waiting && this.#end("silent"));
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
      waiting.answer = readHead(this.#parts[0]);
      if (waiting.answer && waiting.withoutBody) waiting.answer.total = waiting.answer.bodyAt;
    }
    if (waiting.answer && this.#size >= waiting.answer.total) this.#finish();
  }

  #finish() {
    const { resolve, sent, answer, first } = this.#waiting;
    const ms = performance.now() - sent;
    const parts = this.#parts; // concatenated on demand, because this is slow for large images
    this.#waiting = null;
    this.#forget();
    if (answer.closes) this.leave();
    resolve({ ...answer, text: () => Buffer.concat(parts).toString("utf8", answer.bodyAt), ms, sent, first });
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

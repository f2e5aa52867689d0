// The one WebSocket: begins with the secret, comes back by itself.
import { keepToken, takeLink } from "./link";
import { Painter } from "./painter";
import type { ClientMessage, ServerMessage } from "./protocol";
import { notify, state, update } from "./store";

const FIRST_WAIT = 250;
const LONGEST_WAIT = 4000;
const WRONG_TOKEN = 4001;
const FULL = 1013;

export class Connection {
  private socket: WebSocket | null = null;
  private link = takeLink();
  private wait = FIRST_WAIT;
  private timer = 0;
  private session = "";
  private inputs = 0;
  private size = { width: 1, height: 1 };
  /** What this page has set: told to a server that has begun anew. */
  private touched: Record<string, string> = {};
  readonly painter = new Painter({
    ack: (frame, chunk) => this.send({ kind: "ack", frame, chunk }),
    shot: (_id, picture) => download(picture, "easypbr.png"),
  });

  constructor() {
    this.touched = { ...this.link.settings };
    document.addEventListener("visibilitychange", () => this.pause());
    window.addEventListener("online", () => this.retry());
    if (this.link.token) this.open();
    else update({ phase: "denied", reason: "" });
  }

  get token(): string {
    return this.link.token;
  }
  get settings(): Record<string, string> {
    return this.touched;
  }
  get isLive(): boolean {
    return this.socket?.readyState === WebSocket.OPEN && state.phase === "live";
  }

  useToken(token: string): void {
    this.link.token = token;
    keepToken(token);
    this.open();
  }

  retry(): void {
    if (this.socket && this.socket.readyState <= WebSocket.OPEN) return;
    this.wait = FIRST_WAIT;
    this.open();
  }

  send(message: ClientMessage): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** A message about an input: numbered, so that a picture can name it. */
  input(message: ClientMessage): void {
    if (!this.isLive || !state.control.controls) return;
    const id = ++this.inputs;
    this.painter.sentInput(id);
    this.send({ ...message, id });
  }

  set(name: string, value: string): void {
    this.touched[name] = value;
    this.send({ kind: "set", name, value });
  }

  resize(width: number, height: number): void {
    if (width === this.size.width && height === this.size.height) return;
    this.size = { width, height };
    if (this.isLive && state.control.controls) this.send({ kind: "resize", ...this.size });
  }

  private pause(): void {
    this.send({ kind: "pause", paused: document.hidden });
    if (!document.hidden) this.retry();
  }

  private open(): void {
    clearTimeout(this.timer);
    const address = new URL("socket", document.baseURI);
    address.protocol = address.protocol.replace("http", "ws");
    address.hash = address.search = "";
    const socket = new WebSocket(address, "easypbr.1");
    socket.binaryType = "arraybuffer";
    socket.onopen = () => socket.send(JSON.stringify({ kind: "hello", token: this.link.token, ...this.size }));
    socket.onmessage = (event) => this.receive(event.data as string | ArrayBuffer);
    socket.onclose = (event) => this.closed(socket, event);
    this.socket = socket;
    if (state.phase !== "lost") update({ phase: "connecting", reason: "" });
  }

  private closed(socket: WebSocket, event: CloseEvent): void {
    if (this.socket !== socket) return;
    this.socket = null;
    if (event.code === WRONG_TOKEN) {
      update({ phase: "denied", reason: "That secret does not fit this server." });
      return;
    }
    update({ phase: event.code === FULL ? "full" : "lost", reason: event.reason });
    const delay = this.wait * (0.75 + 0.5 * Math.random());
    this.wait = Math.min(LONGEST_WAIT, this.wait * 2);
    this.timer = window.setTimeout(() => this.open(), delay);
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data === "string") this.read(JSON.parse(data) as ServerMessage);
    else this.painter.take(data).catch(() => notify("A picture could not be decoded", true));
  }

  private read(message: ServerMessage): void {
    switch (message.kind) {
      case "welcome":
        return this.begin(message);
      case "settings":
        return update({ values: { ...state.values, ...message.values } });
      case "camera":
        return update({ camera: message.text });
      case "scene":
        return update({ nodes: message.nodes, selected: message.selected, channel: message.channel });
      case "control":
        return this.control(message);
      case "notice":
        return notify(message.text, message.error);
      case "pick":
        return update({ pick: message });
      case "animation":
        return update({ animation: message.names.length ? message : null });
      case "statistics":
        return update({ statistics: message });
    }
  }

  private begin(message: ServerMessage & { kind: "welcome" }): void {
    this.wait = FIRST_WAIT;
    this.painter.restart();
    const isNew = this.session !== message.session;
    const isAgain = this.session !== "";
    this.session = message.session;
    update({ phase: "live", reason: "", watches: message.watches, channels: message.channels, fields: message.fields });
    // What a link asks for, or what was seen before the server began anew.
    this.restore = isNew ? { camera: isAgain ? state.camera : this.link.camera, settings: { ...this.touched } } : null;
    if (document.hidden) this.pause();
  }

  private restore: { camera: string; settings: Record<string, string> } | null = null;

  private control(control: ServerMessage & { kind: "control" }): void {
    const gained = control.controls && !state.control.controls;
    update({ control });
    if (!control.controls) return;
    if (gained || this.restore) this.send({ kind: "resize", ...this.size });
    const restore = this.restore;
    this.restore = null;
    if (!restore) return;
    for (const [name, value] of Object.entries(restore.settings)) this.send({ kind: "set", name, value });
    if (restore.camera) this.send({ kind: "camera", text: restore.camera });
  }
}

export function download(picture: Blob, name: string): void {
  const anchor = document.createElement("a");
  anchor.href = URL.createObjectURL(picture);
  anchor.download = name;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 10000);
}

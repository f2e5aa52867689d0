// A view's connection: begins with the secret, comes back by itself. What carries the messages is a Wire.
import type { Link } from "./link";
import { Painter } from "./painter";
import { refusalOf, type ClientMessage, type ServerMessage } from "./protocol";
import { Store } from "./store";
import { decodesVideo } from "./video";
import type { Wire } from "./wire";

const FIRST_WAIT = 250;
const LONGEST_WAIT = 4000;
const WRONG_TOKEN = 4001;
const FULL = 1013;
/** Messages that change nothing for others. */
const SILENT = new Set(["ack", "pause", "decodes"]);

export interface Rules {
  needsToken: boolean;
  /** All clients are one person's: who does something controls. */
  takesControl: boolean;
  /** Pictures reach this client alone, each of them, in order: they may need one another. */
  takesVideo: boolean;
  keepToken?: (token: string) => void;
}

export class Connection {
  readonly store = new Store();
  private wait = FIRST_WAIT;
  private timer = 0;
  private begun = false;
  private session = "";
  private inputs = 0;
  /** The server has said so; it has, or it will when what was sent arrives. */
  private controlled = false;
  private holds = false;
  /** The view is the page's own. */
  private own = false;
  private paused = false;
  private decodes = false;
  private size = { width: 1, height: 1 };
  /** What this page has set: told to a server that has begun anew. */
  private touched: Record<string, string> = {};
  /** Canvases that can be seen, as far as is known. */
  private hidden = new Map<Element, boolean>();
  readonly painter = new Painter(this.store, {
    ack: (frame, chunk, busy) => this.send({ kind: "ack", frame, chunk, busy }),
    file: download,
    decodes: (h264) => {
      this.decodes = h264;
      this.send({ kind: "decodes", h264 });
    },
  });

  constructor(
    private wire: Wire,
    private link: Link,
    private rules: Rules,
  ) {
    this.touched = { ...link.settings };
    if (rules.takesVideo) void decodesVideo().then((decodes) => this.take(decodes));
    document.addEventListener("visibilitychange", this.turned);
    window.addEventListener("online", this.retry);
    if (link.token) this.open();
    else if (rules.needsToken) this.store.update({ phase: "denied", reason: "" });
  }

  /** For good. */
  end(): void {
    document.removeEventListener("visibilitychange", this.turned);
    window.removeEventListener("online", this.retry);
    clearTimeout(this.timer);
    this.wire.end();
  }

  get token(): string {
    return this.link.token;
  }
  get settings(): Record<string, string> {
    return this.touched;
  }
  get isLive(): boolean {
    return this.wire.isOpen && this.store.state.phase === "live";
  }

  useToken(token: string): void {
    this.link.token = token;
    this.rules.keepToken?.(token);
    this.open();
  }

  retry = (): void => {
    if (!this.begun || this.wire.isBusy || this.store.state.phase === "denied") return;
    this.wait = FIRST_WAIT;
    this.open();
  };

  /** What changes the view is preceded by taking control where this may be taken at once. */
  send(message: ClientMessage): void {
    if (!this.wire.isOpen) return;
    const refusal = refusalOf(message);
    if (refusal) return this.store.notify(`Too long for the server: ${refusal}`, true);
    if (this.rules.takesControl && !this.holds && !SILENT.has(message.kind)) {
      this.wire.send(JSON.stringify({ kind: "act", what: "take" }));
      // Places of what follows are those of this page's picture.
      if (message.kind !== "resize") this.wire.send(JSON.stringify({ kind: "resize", ...this.size }));
      this.holds = true;
    }
    this.wire.send(JSON.stringify(message));
  }

  /** A message about an input: numbered, so that a picture can name it. */
  input(message: ClientMessage): void {
    if (!this.isLive || !this.store.state.control.controls) return;
    const id = ++this.inputs;
    this.painter.sentInput(id);
    this.send({ ...message, id });
  }

  set(name: string, value: string): void {
    const message = { kind: "set", name, value };
    if (!refusalOf(message)) this.touched[name] = value;
    this.send(message);
  }

  resize(width: number, height: number): void {
    if (width === this.size.width && height === this.size.height) return;
    this.size = { width, height };
    // Without a secret it begins with the first canvas.
    if (!this.begun && !this.rules.needsToken) this.open();
    if (this.isLive && this.store.state.control.controls) this.send({ kind: "resize", ...this.size });
  }

  /** A view of the page's own, or the shared one. */
  lookAt(own: boolean): void {
    this.restore = null;
    this.send({ kind: "view", own, ...this.size });
  }

  /** A canvas has come into sight, or has gone out of it; undefined: it is no more. */
  seen(canvas: Element, visible: boolean | undefined): void {
    if (visible === undefined) this.hidden.delete(canvas);
    else this.hidden.set(canvas, !visible);
    this.pause();
  }

  private pause(): void {
    const paused = document.hidden || [...this.hidden.values()].every(Boolean); // Without a canvas too.
    if (!this.isLive || paused === this.paused) return;
    this.send({ kind: "pause", paused });
    this.paused = paused;
  }

  private turned = (): void => {
    this.pause();
    if (!document.hidden) this.retry();
  };

  /** Known before the connection, or after it. */
  private take(decodes: boolean): void {
    this.decodes = decodes;
    if (decodes && this.isLive) this.send({ kind: "decodes", h264: true });
  }

  private open(): void {
    clearTimeout(this.timer);
    this.begun = true;
    this.wire.open({
      opened: () => this.wire.send(JSON.stringify({ kind: "hello", token: this.link.token, ...this.size })),
      received: (data) => this.receive(data),
      closed: (code, reason) => this.closed(code, reason),
    });
    if (this.store.state.phase !== "lost") this.store.update({ phase: "connecting", reason: "" });
  }

  private closed(code: number, reason: string): void {
    if (code === WRONG_TOKEN) {
      this.store.update({ phase: "denied", reason: "That secret does not fit this server." });
      return;
    }
    this.store.update({ phase: code === FULL ? "full" : "lost", reason });
    const delay = this.wait * (0.75 + 0.5 * Math.random());
    this.wait = Math.min(LONGEST_WAIT, this.wait * 2);
    this.timer = window.setTimeout(() => this.open(), delay);
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data === "string") this.read(JSON.parse(data) as ServerMessage);
    else this.painter.take(data).catch(() => this.store.notify("A picture could not be decoded", true));
  }

  private read(message: ServerMessage): void {
    const { state } = this.store;
    const update = (change: Parameters<Store["update"]>[0]) => this.store.update(change);
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
        return this.store.notify(message.text, message.error);
      case "pick":
        return update({ pick: message });
      case "animation":
        return update({ animation: message.names.length ? message : null });
      case "panels":
        return update({ panels: message.panels });
      case "tool":
        return update({ tools: { ...state.tools, [message.name]: message.widgets } });
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
    this.holds = false;
    this.paused = false;
    this.store.update({ phase: "live", reason: "", watches: message.watches, channels: message.channels, fields: message.fields });
    if (this.decodes) this.send({ kind: "decodes", h264: true });
    // What a link asks for, or what was seen before the server began anew.
    // A view of its own went with the connection.
    const returns = isAgain && this.own;
    this.own = false;
    if (returns) this.send({ kind: "view", own: true, ...this.size });
    const camera = isAgain ? this.store.state.camera : this.link.camera;
    this.restore = isNew || returns ? { camera, settings: { ...this.touched }, own: returns, isOld: isAgain } : null;
    this.pause();
  }

  /** `own`: of a view of its own; `isOld`: of before the server began anew, else of the link. */
  private restore: { camera: string; settings: Record<string, string>; own: boolean; isOld: boolean } | null = null;

  private control(control: ServerMessage & { kind: "control" }): void {
    const gained = control.controls && !this.controlled;
    this.controlled = this.holds = control.controls;
    const isOther = this.painter.look(control.view);
    if (isOther) this.store.update({ pick: null, tools: {}, panels: [] });
    this.own = control.view !== 0;
    this.store.update({ control: { ...control, controls: control.controls || this.rules.takesControl } });
    if (!control.controls) {
      // Who does may have moved on when the page gets control: what was seen before the server began anew is old then.
      if (control.taken && this.restore?.isOld && !this.restore.own) this.restore = null;
      return;
    }
    if (gained || isOther || this.restore) this.send({ kind: "resize", ...this.size });
    const restore = this.restore;
    if (!restore || (restore.own && !this.own)) return;
    this.restore = null;
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

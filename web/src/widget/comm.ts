// A notebook's channel as a Wire: messages of a widget's model, which every page with this notebook gets.
import type { Wire, WireEvents } from "../wire";

/** What anywidget hands over, as far as it is used here. */
export interface Model {
  get(name: string): unknown;
  on(event: "msg:custom", listener: (content: Incoming, buffers: DataView[]) => void): void;
  off(event: "msg:custom", listener: (content: Incoming, buffers: DataView[]) => void): void;
  send(content: Outgoing): void;
}

export interface Incoming {
  client: number;
  text?: string;
  code?: number;
  reason?: string;
  /** Bytes come with this one: did they arrive? */
  probe?: boolean;
  /** Bytes in base 64, where they do not arrive by themselves. */
  data?: string;
}

export interface Outgoing {
  client: number;
  text?: string;
  gone?: boolean;
  arrives?: boolean;
}

/** Who says nothing for three minutes is forgotten; hidden pages may act once a minute. */
const ALIVE_MS = 45000;
/** Without an answer for so long, the kernel is busy or there is none. */
export const PATIENCE_MS = 8000;

export class CommWire implements Wire {
  private events: WireEvents | null = null;
  private client = 0;
  private alive = 0;

  constructor(private model: Model) {
    model.on("msg:custom", this.take);
  }

  open(events: WireEvents): void {
    this.leave();
    this.events = events;
    // Another page with the same notebook has another number.
    this.client = crypto.getRandomValues(new Uint32Array(1))[0] as number;
    this.alive = window.setInterval(() => this.model.send({ client: this.client }), ALIVE_MS);
    queueMicrotask(() => this.events === events && events.opened());
  }

  send(text: string): void {
    if (this.isOpen) this.model.send({ client: this.client, text });
  }

  get isOpen(): boolean {
    return this.events !== null;
  }

  get isBusy(): boolean {
    return this.isOpen;
  }

  end(): void {
    this.leave();
    this.model.off("msg:custom", this.take);
  }

  private leave(): void {
    clearInterval(this.alive);
    if (this.events) this.model.send({ client: this.client, gone: true });
    this.events = null;
  }

  private take = (content: Incoming, buffers: DataView[]): void => {
    const { events } = this;
    if (!events || content.client !== this.client) return;
    if (content.probe) return this.model.send({ client: this.client, arrives: (buffers?.[0]?.byteLength ?? 0) > 0 });
    if (content.data !== undefined) return events.received(Uint8Array.from(atob(content.data), (letter) => letter.charCodeAt(0)).buffer);
    if (content.code) {
      clearInterval(this.alive);
      this.events = null;
      events.closed(content.code, content.reason ?? "");
    } else if (content.text !== undefined) {
      events.received(content.text);
    }
    // A copy: the view may be one into a larger buffer.
    for (const view of buffers ?? []) events.received(new Uint8Array(view.buffer, view.byteOffset, view.byteLength).slice().buffer);
  };
}

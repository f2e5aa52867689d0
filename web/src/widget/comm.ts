// A notebook's channel as a Wire: messages of a widget's model, which every page with this notebook gets.
import type { Wire, WireEvents } from "../wire";

/** What anywidget hands over, as far as it is used here. */
export interface Model {
  get(name: string): unknown;
  on(event: "msg:custom", listener: (content: Incoming, buffers: DataView[]) => void): void;
  /** The kernel that the model belongs to has ended. */
  on(event: "comm_live_update" | "comm:close", listener: () => void): void;
  off(event: string, listener: unknown): void;
  /** Throws once the kernel has ended. */
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

const ENDS = ["comm_live_update", "comm:close"] as const;
const LOST = 1006;

export class CommWire implements Wire {
  private events: WireEvents | null = null;
  private client = 0;
  private alive = 0;

  constructor(private model: Model) {
    model.on("msg:custom", this.take);
    for (const event of ENDS) model.on(event, this.lose);
    window.addEventListener("pagehide", this.sayGone);
  }

  open(events: WireEvents): void {
    this.leave();
    this.events = events;
    // Another page with the same notebook has another number.
    this.client = crypto.getRandomValues(new Uint32Array(1))[0] as number;
    this.alive = window.setInterval(() => this.tell({}), ALIVE_MS);
    queueMicrotask(() => this.events === events && events.opened());
  }

  send(text: string): void {
    if (this.isOpen) this.tell({ text });
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
    for (const event of ENDS) this.model.off(event, this.lose);
    window.removeEventListener("pagehide", this.sayGone);
  }

  private tell(what: Omit<Outgoing, "client">): void {
    try {
      this.model.send({ client: this.client, ...what });
    } catch {
      this.lose();
    }
  }

  private sayGone = (): void => {
    if (this.isOpen) this.tell({ gone: true });
  };

  private lose = (): void => this.close(LOST, "");

  private close(code: number, reason: string): void {
    const { events } = this;
    clearInterval(this.alive);
    this.events = null;
    events?.closed(code, reason);
  }

  private leave(): void {
    clearInterval(this.alive);
    const open = this.isOpen;
    this.events = null;
    if (open) this.tell({ gone: true });
  }

  private take = (content: Incoming, buffers: DataView[]): void => {
    const { events } = this;
    if (!events || content.client !== this.client) return;
    if (content.probe) return this.tell({ arrives: (buffers?.[0]?.byteLength ?? 0) > 0 });
    if (content.data !== undefined) return events.received(Uint8Array.from(atob(content.data), (letter) => letter.charCodeAt(0)).buffer);
    if (content.code) {
      this.close(content.code, content.reason ?? "");
    } else if (content.text !== undefined) {
      events.received(content.text);
    }
    // A copy: the view may be one into a larger buffer.
    for (const view of buffers ?? []) events.received(new Uint8Array(view.buffer, view.byteOffset, view.byteLength).slice().buffer);
  };
}

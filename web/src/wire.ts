// What carries messages to the server and back.
export interface WireEvents {
  opened(): void;
  received(data: string | ArrayBuffer): void;
  closed(code: number, reason: string): void;
}

export interface Wire {
  /** Begins anew; what is told of an earlier beginning is told to nobody. */
  open(events: WireEvents): void;
  send(text: string): void;
  /** What is sent arrives. */
  readonly isOpen: boolean;
  /** It is open, or will be. */
  readonly isBusy: boolean;
  /** For good. */
  end(): void;
}

export class SocketWire implements Wire {
  private socket: WebSocket | null = null;

  open(events: WireEvents): void {
    const address = new URL("socket", document.baseURI);
    address.protocol = address.protocol.replace("http", "ws");
    address.hash = address.search = "";
    const socket = new WebSocket(address, "easypbr.1");
    socket.binaryType = "arraybuffer";
    socket.onopen = () => events.opened();
    socket.onmessage = (event) => events.received(event.data as string | ArrayBuffer);
    socket.onclose = (event) => {
      if (this.socket !== socket) return;
      this.socket = null;
      events.closed(event.code, event.reason);
    };
    this.socket = socket;
  }

  send(text: string): void {
    if (this.isOpen) this.socket?.send(text);
  }

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  get isBusy(): boolean {
    return this.socket !== null && this.socket.readyState <= WebSocket.OPEN;
  }

  end(): void {
    const { socket } = this;
    this.socket = null;
    socket?.close();
  }
}

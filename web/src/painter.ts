// Pictures onto the canvas: in order, the newest only, each answered when it is drawn.
import { CODEC_H264, CODEC_NAMES, FLAG_EXACT, FLAG_LAST, FRAME_MOVING, FRAME_STILL, HEADER_BYTES, fileName, mimeOf, readHeader, type FrameHeader } from "./protocol";
import type { Store } from "./store";
import { VideoPictures } from "./video";

export interface PainterHooks {
  /** `busy`: seconds since it came. */
  ack(frame: number, chunk: number, busy: number): void;
  /** A still or a video that was asked for. */
  file(content: Blob, name: string): void;
  /** Whether H.264 can be decoded; true, again: its place in the video is lost. */
  decodes(h264: boolean): void;
}

type Picture = ImageBitmap | VideoFrame;

/** Chunks of one picture. */
interface Parts {
  frame: number;
  chunks: ArrayBuffer[];
}

export class Painter {
  /** When each input was sent, until a picture shows it. */
  private inputs = new Map<number, number>();
  private latencies: number[] = [];
  private arrivals: { time: number; bytes: number; draws: boolean }[] = [];
  private still: Parts = { frame: 0, chunks: [] };
  private file: Parts = { frame: 0, chunks: [] };
  private video: VideoPictures;
  private drawn = 0;
  private view = 0;
  /** All show the same pictures. */
  private canvases = new Set<HTMLCanvasElement>();
  /** Of the picture on the canvas. */
  last: FrameHeader | null = null;

  constructor(
    private store: Store,
    private hooks: PainterHooks,
  ) {
    this.video = new VideoPictures({ lost: () => hooks.decodes(true), failed: () => hooks.decodes(false) });
    setInterval(() => this.tellRates(), 500);
  }

  attach(canvas: HTMLCanvasElement): void {
    const [other] = this.canvases;
    this.canvases.add(canvas);
    if (!other || !this.last) return;
    canvas.width = other.width;
    canvas.height = other.height;
    Object.assign(canvas.dataset, other.dataset);
    canvas.getContext("2d")?.drawImage(other, 0, 0);
  }

  detach(canvas: HTMLCanvasElement): void {
    this.canvases.delete(canvas);
  }

  /** Another connection or view: its pictures are numbered anew. What is on the canvas until one comes is not its own. */
  restart(): void {
    this.drawn = 0;
    this.note({ exact: "false" });
    this.store.update({ exact: false });
    this.still = { frame: 0, chunks: [] };
    this.file = { frame: 0, chunks: [] };
    this.inputs.clear();
    this.video.reset();
  }

  /** Which view's pictures are shown from now on. Returns whether it is another one. */
  look(view: number): boolean {
    if (view === this.view) return false;
    this.view = view;
    this.restart();
    return true;
  }

  sentInput(id: number): void {
    this.inputs.set(id, performance.now());
    if (this.inputs.size > 200) this.inputs.delete(this.inputs.keys().next().value as number);
  }

  async take(data: ArrayBuffer): Promise<void> {
    const header = readHeader(data);
    const came = performance.now();
    const draws = header.kind === FRAME_MOVING || header.kind === FRAME_STILL;
    this.arrivals.push({ time: came, bytes: data.byteLength, draws: draws && (header.flags & FLAG_LAST) !== 0 });
    try {
      if (header.codec === CODEC_H264) await this.paint(header, await this.video.decode(header, data));
      else if (header.kind === FRAME_MOVING) await this.paint(header, await bitmapOf(header, [data]));
      else await this.collect(header, data);
    } finally {
      this.hooks.ack(header.frame, header.chunk, (performance.now() - came) / 1000);
    }
  }

  private async collect(header: FrameHeader, data: ArrayBuffer): Promise<void> {
    const parts = header.kind === FRAME_STILL ? this.still : this.file;
    if (header.chunk === 0) {
      parts.frame = header.frame;
      parts.chunks = [];
    }
    if (parts.frame !== header.frame || parts.chunks.length !== header.chunk) return;
    parts.chunks.push(data);
    if (!(header.flags & FLAG_LAST)) return;
    const chunks = parts.chunks;
    parts.chunks = [];
    if (header.kind === FRAME_STILL) await this.paint(header, await bitmapOf(header, chunks));
    else this.hooks.file(blobOf(header, chunks), fileName(header));
  }

  private async paint(header: FrameHeader, picture: Picture | null): Promise<void> {
    if (!picture) return;
    if (this.canvases.size > 0 && header.view === this.view && header.frame > this.drawn) {
      this.drawn = header.frame;
      this.last = header;
      for (const canvas of this.canvases) draw(canvas, picture, header);
      this.measure(header);
    }
    picture.close();
  }

  private note(values: Record<string, string>): void {
    for (const canvas of this.canvases) Object.assign(canvas.dataset, values);
  }

  private measure(header: FrameHeader): void {
    const exact = (header.flags & FLAG_EXACT) !== 0;
    this.note({ frame: String(header.frame), input: String(header.input), exact: String(exact) });
    const codec = CODEC_NAMES[header.codec] ?? "";
    if (header.kind === FRAME_MOVING) this.note({ moving: codec });
    this.store.update({ exact, drawn: true, ...(header.kind === FRAME_MOVING && { codec }) });
    const sent = this.inputs.get(header.input);
    if (sent === undefined) return;
    const latency = performance.now() - sent;
    this.latencies.push(latency);
    if (this.latencies.length > 60) this.latencies.shift();
    // Without what the server waited and drew: on the way there, encoding, on the way here, decoding.
    this.note({ latency: `${latency} ${latency - header.waitUs / 1000} ${header.encodeUs / 1000}` });
    for (const id of [...this.inputs.keys()]) if (id <= header.input) this.inputs.delete(id);
  }

  private tellRates(): void {
    const now = performance.now();
    this.arrivals = this.arrivals.filter((arrival) => now - arrival.time < 2000);
    const bytes = this.arrivals.reduce((sum, arrival) => sum + arrival.bytes, 0);
    const pictures = this.arrivals.filter((arrival) => arrival.draws).length;
    const sorted = [...this.latencies].sort((a, b) => a - b);
    this.store.update({ rate: { fps: pictures / 2, kbytes: bytes / 2000, inputMs: sorted[sorted.length >> 1] ?? 0 } });
  }
}

function blobOf(header: FrameHeader, chunks: ArrayBuffer[]): Blob {
  return new Blob(chunks.map((chunk) => new Uint8Array(chunk, HEADER_BYTES)), { type: mimeOf(header) });
}

function bitmapOf(header: FrameHeader, chunks: ArrayBuffer[]): Promise<ImageBitmap> {
  return createImageBitmap(blobOf(header, chunks), { colorSpaceConversion: "none", premultiplyAlpha: "none" });
}

function draw(canvas: HTMLCanvasElement, picture: Picture, header: FrameHeader): void {
  fit(canvas, header);
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  if (header.kind !== FRAME_MOVING) context.clearRect(0, 0, canvas.width, canvas.height);
  // Videos have even sides.
  context.drawImage(picture, 0, 0, header.width, header.height, 0, 0, canvas.width, canvas.height);
}

/** Pictures at rest have a pixel of the canvas for each of theirs; smaller ones that move are stretched over it. */
function fit(canvas: HTMLCanvasElement, { kind, width, height }: FrameHeader): void {
  const sameShape = Math.abs(canvas.width / canvas.height - width / height) < 0.02;
  if (kind === FRAME_MOVING && sameShape && canvas.width >= width) return;
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
}

// H.264 by WebCodecs: pictures in, frames out. Browsers have it in secure contexts alone: on loopback, and below https.
import { FLAG_KEY, HEADER_BYTES, type FrameHeader } from "./protocol";

/** What every browser with H.264 decodes, in pictures of any size here. */
const PROBE = "avc1.640033";
/** A decoder that gives nothing back for so long holds frames, or has failed without a word. */
const PATIENCE_MS = 1500;
const SEQUENCE_SET = 7;

type Answer = (frame: VideoFrame | null) => void;

export interface VideoHooks {
  /** The place in the video is lost: a key frame is needed. */
  lost(): void;
  /** Nothing can be decoded here. */
  failed(): void;
}

export async function decodesVideo(): Promise<boolean> {
  if (typeof VideoDecoder === "undefined") return false;
  const answer = await VideoDecoder.isConfigSupported({ codec: PROBE, optimizeForLatency: true }).catch(() => null);
  return answer?.supported === true;
}

/** "avc1.PPCCLL" of a key frame's sequence parameter set; empty: it has none. */
export function codecOf(bytes: Uint8Array): string {
  for (let at = 0; at + 6 < bytes.length; at++) {
    if (bytes[at] !== 0 || bytes[at + 1] !== 0 || bytes[at + 2] !== 1) continue;
    if (((bytes[at + 3] as number) & 31) !== SEQUENCE_SET) continue;
    return "avc1." + [...bytes.subarray(at + 4, at + 7)].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  }
  return "";
}

export class VideoPictures {
  private decoder: VideoDecoder | null = null;
  private format = "";
  private waiting = new Map<number, { answer: Answer; since: number }>();
  private timer = 0;
  /** Decoders that have failed: the second one is the browser's own, in software. */
  private failures = 0;

  constructor(private hooks: VideoHooks) {}

  /** The decoded picture, to be closed; null: it cannot be decoded. */
  decode(header: FrameHeader, data: ArrayBuffer): Promise<VideoFrame | null> {
    return new Promise((answer) => {
      const bytes = new Uint8Array(data, HEADER_BYTES);
      const isKey = (header.flags & FLAG_KEY) !== 0;
      try {
        if (isKey) this.begin(codecOf(bytes), header);
        if (!this.decoder) return answer(null);
        this.waiting.set(header.frame, { answer, since: performance.now() });
        this.decoder.decode(new EncodedVideoChunk({ type: isKey ? "key" : "delta", timestamp: header.frame, data: bytes }));
        this.timer ||= window.setTimeout(() => this.watch(), PATIENCE_MS);
      } catch {
        this.waiting.delete(header.frame);
        answer(null);
        this.fail();
      }
    });
  }

  /** Another connection, or none: what is waited for does not come. */
  reset(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    if (this.decoder && this.decoder.state !== "closed") this.decoder.close();
    this.decoder = null;
    this.format = "";
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    for (const { answer } of waiting) answer(null);
  }

  private begin(codec: string, header: FrameHeader): void {
    const format = `${codec} ${header.width} ${header.height}`;
    if (this.decoder && format === this.format) return;
    this.decoder ??= new VideoDecoder({ output: (frame) => this.came(frame), error: () => this.fail() });
    this.decoder.configure({
      codec,
      optimizeForLatency: true,
      hardwareAcceleration: this.failures > 0 ? "prefer-software" : "no-preference",
    });
    this.format = format;
  }

  private came(frame: VideoFrame): void {
    const waits = this.waiting.get(frame.timestamp);
    this.waiting.delete(frame.timestamp);
    if (waits) waits.answer(frame);
    else frame.close();
  }

  private watch(): void {
    this.timer = 0;
    const [oldest] = this.waiting.values();
    if (!oldest) return;
    const waits = performance.now() - oldest.since;
    if (waits >= PATIENCE_MS) this.fail();
    else this.timer = window.setTimeout(() => this.watch(), PATIENCE_MS - waits);
  }

  private fail(): void {
    this.reset();
    this.failures++;
    if (this.failures > 2) this.hooks.failed();
    else this.hooks.lost();
  }
}

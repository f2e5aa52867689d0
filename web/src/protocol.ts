// What goes over the wire: see src/easypbr/remote/messages.h and frame_header.h.

export interface Field {
  name: string;
  doc: string;
  type: "boolean" | "integer" | "number" | "color" | "vector" | "text" | "choice" | "colormap";
  unit?: string;
  auto?: boolean;
  min?: number;
  max?: number;
  choices?: string[];
  sizes?: number[];
  whole?: boolean;
  /** However wide its range is. */
  slider?: boolean;
}

/** A setting: as it was given ("auto" and "follow" too), and what is in force. */
export interface FieldValue {
  value: string;
  latched?: string;
}

export interface SceneNode {
  path: string;
  visible: boolean;
  vertices: number;
  faces: number;
  children?: SceneNode[];
}

export interface Statistics {
  frame_ms: number;
  frames: number;
  total: number;
  width: number;
  height: number;
  pictures: number;
  share: number;
  latency_ms: number;
  software: boolean;
}

export interface Pick {
  id: number;
  hit: boolean;
  object?: string;
  part?: string;
  face?: boolean;
  element?: number;
  position?: [number, number, number];
  depth?: number;
  values?: { label?: number; class?: string; scalars?: Record<string, number> };
}

export interface Animation {
  names: string[];
  current: number;
  plays: boolean;
  time: number;
  duration: number;
  speed: number;
}

/** Of a panel of the program's or the server's. */
export interface Widget {
  type: "text" | "separator" | "section" | "button" | "checkbox" | "text_field" | "slider" | "number" | "combo" | "color" | "plot" | "progress" | "field";
  name: string;
  /** So many of this name come before it. */
  use?: number;
  beside?: boolean;
  value?: string | number | boolean;
  min?: number;
  max?: number;
  whole?: boolean;
  choices?: string[];
  field?: Field;
  /** Of a field that is automatic. */
  latched?: string;
  values?: (number | null)[];
  last?: number;
}

export interface UserPanel {
  name: string;
  error?: string;
  widgets: Widget[];
}

export interface Control {
  controls: boolean;
  taken: boolean;
  may: boolean;
  clients: number;
  /** That the page shows, as pictures name it; 0: the shared one. */
  view: number;
  /** It may ask for a view of its own. */
  own: boolean;
}

export type ServerMessage =
  | { kind: "welcome"; session: string; watches: boolean; channels: string[]; fields: Field[] }
  | { kind: "settings"; values: Record<string, FieldValue> }
  | { kind: "camera"; text: string }
  | { kind: "scene"; nodes: SceneNode[]; selected: string; channel: string }
  | ({ kind: "control" } & Control)
  | { kind: "notice"; text: string; error: boolean }
  | ({ kind: "pick" } & Pick)
  | ({ kind: "animation" } & Animation)
  | { kind: "panels"; panels: UserPanel[] }
  | { kind: "tool"; name: string; widgets: Widget[] }
  | ({ kind: "statistics" } & Statistics);

export type ClientMessage = { kind: string } & Record<string, string | number | boolean>;

/** Bytes of a text that the server takes at most; a longer one would end the connection. */
export const MOST_TEXT = 8192;
const MOST_NAME = 256;

/** Why the server would not take a message; empty: it would. */
export function refusalOf(message: ClientMessage): string {
  for (const [name, value] of Object.entries(message)) {
    const most = message.kind === "set" && name === "name" ? MOST_NAME : MOST_TEXT;
    if (typeof value === "string" && new TextEncoder().encode(value).length > most) return `${name}: at most ${most} bytes`;
  }
  return "";
}

export const FRAME_MOVING = 1;
export const FRAME_STILL = 2;
export const FLAG_LAST = 1;
export const FLAG_EXACT = 2;
export const FLAG_KEY = 8;
export const CODEC_H264 = 3;

export interface FrameHeader {
  kind: number;
  codec: number;
  flags: number;
  frame: number;
  input: number;
  view: number;
  width: number;
  height: number;
  refined: number;
  total: number;
  chunk: number;
  bytes: number;
  drawUs: number;
  encodeUs: number;
  waitUs: number;
}

export const HEADER_BYTES = 40;

export function readHeader(data: ArrayBuffer): FrameHeader {
  const view = new DataView(data);
  const short = (at: number) => view.getUint16(at, true);
  const long = (at: number) => view.getUint32(at, true);
  return {
    kind: view.getUint8(0),
    codec: view.getUint8(1),
    flags: short(2),
    frame: long(4),
    input: long(8),
    view: short(12),
    width: short(14),
    height: short(16),
    refined: short(18),
    total: short(20),
    chunk: short(22),
    bytes: long(24),
    drawUs: long(28),
    encodeUs: long(32),
    waitUs: long(36),
  };
}

export const CODEC_NAMES = ["", "JPEG", "PNG", "H.264"];

const MIMES = ["", "image/jpeg", "image/png", "", "video/mp4", "video/webm", "image/gif"];

export const mimeOf = (header: FrameHeader): string => MIMES[header.codec] ?? "";
/** What a file of it is called. */
export const fileName = (header: FrameHeader): string => `easypbr.${mimeOf(header).split("/")[1]}`;

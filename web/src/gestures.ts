// Mouse, touch, pen and keys on the canvas become messages: at most one for a moving pointer and one for the wheel in a
// frame of the display; presses, releases and keys are never merged.
import type { Connection } from "./connection";
import { Pace } from "./pace";

type Button = "left" | "right" | "middle";

interface Point {
  x: number;
  y: number;
}

const BUTTONS: Button[] = ["left", "middle", "right"];
/** What a notch of the wheel zooms by, in the library's camera control. */
const NOTCH = 0.88;
const DOUBLE_TAP_MS = 350;
const DOUBLE_TAP_PX = 30;
const CLICK_PX = 4;
const TURN_DEG = 5;
const FLY = new Set(["W", "A", "S", "D", "Q", "E"]);

export interface GestureHooks {
  /** Pixels of the picture for each of the page. */
  scale(): number;
  clicked(at: Point): void;
  /** Somebody begins to do something here. */
  entered(): void;
  /** Whether the wheel zooms; else the document scrolls. */
  takesWheel(): boolean;
}

export class Gestures {
  private fingers = new Map<number, Point>();
  private pending: { at: Point; wheel: number; shift: boolean } | null = null;
  private pressed: { at: Point; button: Button } | null = null;
  private moved = false;
  private lastTap = { at: { x: 0, y: 0 }, time: -1e9 };
  private pinch = { distance: 0, wheel: 0 };
  private time = 0;
  /** That are down: what a key stands for may be another letter when it comes up, with Alt say. */
  private keys = new Map<string, string>();
  private pace = new Pace();

  constructor(
    private canvas: HTMLCanvasElement,
    private connection: Connection,
    private hooks: GestureHooks,
  ) {
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.up(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("keydown", (event) => this.key(event, true));
    canvas.addEventListener("keyup", (event) => this.key(event, false));
    canvas.addEventListener("blur", () => this.release());
    window.addEventListener("blur", this.release);
  }

  /** Of what outlives the canvas. */
  end(): void {
    window.removeEventListener("blur", this.release);
  }

  private place(event: MouseEvent): Point {
    const box = this.canvas.getBoundingClientRect();
    const scale = this.hooks.scale();
    return { x: (event.clientX - box.left) * scale, y: (event.clientY - box.top) * scale };
  }

  private pointer(action: string, button: Button, at: Point, wheel = 0, shift = false): void {
    const { x, y } = at;
    this.connection.input({ kind: "pointer", action, button, x, y, wheel, shift, time: this.time });
  }

  /** Sends what is waiting, so that the order stays. */
  private flush(): void {
    this.pace.flush();
  }

  /** A wheel's message says where the pointer is. */
  private sendPending(): void {
    const { pending } = this;
    this.pending = null;
    if (!pending) return;
    if (this.pressed) this.pointer("move", "left", pending.at, 0, pending.shift);
    if (pending.wheel !== 0) this.pointer("wheel", "left", pending.at, pending.wheel, pending.shift);
  }

  private later(at: Point, wheel: number, shift: boolean): void {
    this.pending = { at, wheel: (this.pending?.wheel ?? 0) + wheel, shift };
    this.pace.later(() => this.sendPending());
  }

  private down(event: PointerEvent): void {
    this.canvas.focus({ preventScroll: true });
    this.hooks.entered();
    this.canvas.setPointerCapture(event.pointerId);
    this.time = event.timeStamp / 1000;
    const at = this.place(event);
    if (event.pointerType === "touch") return this.fingerDown(event, at);
    if (this.pressed) return;
    this.press(at, BUTTONS[event.button] ?? "left", event.shiftKey);
  }

  private press(at: Point, button: Button, shift: boolean): void {
    this.flush();
    this.pressed = { at, button };
    this.moved = false;
    this.pointer("move", button, at, 0, shift);
    this.pointer("press", button, at, 0, shift);
  }

  private letGo(at: Point, shift: boolean): void {
    if (!this.pressed) return;
    this.flush();
    const { button } = this.pressed;
    this.pressed = null;
    this.pointer("release", button, at, 0, shift);
    if (!this.moved && button === "left") this.hooks.clicked(at);
  }

  private fingerDown(event: PointerEvent, at: Point): void {
    this.fingers.set(event.pointerId, at);
    if (this.fingers.size === 1) {
      // A second tap nearby counts as one at the same place: fingers are wide.
      const again = event.timeStamp - this.lastTap.time < DOUBLE_TAP_MS && distance(at, this.lastTap.at) < DOUBLE_TAP_PX * this.hooks.scale();
      if (again) at = this.lastTap.at;
      this.lastTap = { at, time: event.timeStamp };
      return this.press(at, "left", false);
    }
    if (this.fingers.size !== 2) return;
    this.moved = true;
    if (this.pressed) this.letGo(this.pressed.at, false);
    const [a, b] = [...this.fingers.values()] as [Point, Point];
    this.pinch = { distance: distance(a, b), wheel: 0 };
    this.press(middle(a, b), "right", false);
    this.moved = true;
  }

  private move(event: PointerEvent): void {
    this.time = event.timeStamp / 1000;
    const at = this.place(event);
    if (event.pointerType === "touch") return this.fingerMove(event, at);
    if (this.pressed && distance(at, this.pressed.at) > CLICK_PX) this.moved = true;
    if (this.pressed) this.later(at, 0, event.shiftKey);
  }

  private fingerMove(event: PointerEvent, at: Point): void {
    if (!this.fingers.has(event.pointerId)) return;
    this.fingers.set(event.pointerId, at);
    if (this.fingers.size === 1) {
      if (this.pressed && distance(at, this.pressed.at) > CLICK_PX * this.hooks.scale()) this.moved = true;
      return this.later(at, 0, false);
    }
    const [a, b] = [...this.fingers.values()] as [Point, Point];
    const apart = Math.max(1, distance(a, b));
    const wheel = Math.log(apart / this.pinch.distance) / -Math.log(NOTCH);
    this.pinch.distance = apart;
    this.later(middle(a, b), wheel, false);
  }

  private up(event: PointerEvent): void {
    this.time = event.timeStamp / 1000;
    const at = this.place(event);
    if (event.pointerType !== "touch") return this.letGo(at, event.shiftKey);
    const fingers = [...this.fingers.values()];
    this.fingers.delete(event.pointerId);
    if (fingers.length === 1) this.letGo(this.moved ? at : (this.pressed?.at ?? at), false);
    else if (fingers.length === 2) this.letGo(middle(fingers[0] as Point, fingers[1] as Point), false);
  }

  private wheel(event: WheelEvent): void {
    if (!this.hooks.takesWheel()) return;
    event.preventDefault();
    this.time = event.timeStamp / 1000;
    const notches = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
    this.later(this.place(event), -Math.max(-5, Math.min(5, notches)), event.shiftKey);
  }

  private key(event: KeyboardEvent, down: boolean): void {
    if (down && (event.ctrlKey || event.metaKey)) return this.shortcut(event);
    const place = event.code || event.key;
    if (!down) return this.keyUp(event, place);
    if (event.altKey) return;
    const key = event.key.length === 1 ? event.key.toUpperCase() : "";
    if (!FLY.has(key) && key !== "F") return this.turn(event);
    event.preventDefault();
    if (this.keys.has(place)) return;
    this.keys.set(place, key);
    this.connection.input({ kind: "key", action: "down", key, shift: event.shiftKey });
  }

  private keyUp(event: KeyboardEvent, place: string): void {
    // Browsers on macOS do not tell of keys that come up while it is down.
    if (event.key === "Meta") return this.keys.size > 0 ? this.release() : undefined;
    const key = this.keys.get(place);
    if (!key) return;
    event.preventDefault();
    this.keys.delete(place);
    this.connection.input({ kind: "key", action: "up", key, shift: event.shiftKey });
  }

  private shortcut(event: KeyboardEvent): void {
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    this.connection.send({ kind: "act", what: key === "z" && !event.shiftKey ? "undo" : "redo" });
  }

  private turn(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-TURN_DEG, 0],
      ArrowRight: [TURN_DEG, 0],
      ArrowUp: [0, TURN_DEG],
      ArrowDown: [0, -TURN_DEG],
    };
    const by = turns[event.key];
    const zoom = event.key === "+" || event.key === "=" ? 1 : event.key === "-" ? -1 : 0;
    if (!by && !zoom) return;
    event.preventDefault();
    if (by) return this.connection.input({ kind: "turn", right: by[0], up: by[1] });
    const scale = this.hooks.scale();
    const centre = { x: (this.canvas.clientWidth * scale) / 2, y: (this.canvas.clientHeight * scale) / 2 };
    this.later(centre, zoom, false);
  }

  private release = (): void => {
    if (this.keys.size === 0 && !this.pressed) return;
    this.keys.clear();
    this.fingers.clear();
    this.pressed = null;
    this.pending = null;
    this.connection.input({ kind: "blur" });
  };
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

function middle(a: Point, b: Point): Point {
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
}

// A picture that turns when it is dragged. All of it is in this one document; nothing is asked of anybody.
import { around, clamped, indexOf, rowStep, type Orbit, type Place } from "./grid";
import { Pictures } from "./pictures";
import "./orbit.css";

/** Of a drag over the picture's height, as in the window. */
const DEGREES_PER_HEIGHT = 200;
const REACH = 3;

function canvasFor(orbit: Orbit, label: string): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = orbit.width;
  canvas.height = orbit.height;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-label", `${label}. Drag it or use the arrow keys to turn it; Home shows it as at first.`);
  canvas.className = orbit.rows.length > 1 ? "picture" : "picture flat";
  return canvas;
}

function degrees(orbit: Orbit, index: number): string {
  const azimuth = Math.round(((index % orbit.columns) * 360) / orbit.columns);
  const elevation = Math.round(orbit.rows[Math.floor(index / orbit.columns)] ?? 0);
  return `${azimuth} degrees around, ${elevation} degrees up`;
}

class Turner {
  private place: Place;
  private pictures: Pictures;
  private canvas: HTMLCanvasElement;
  private wanted = -1;
  private grip: { id: number; x: number; y: number } | null = null;

  constructor(
    private orbit: Orbit,
    private start: HTMLImageElement,
    private status: HTMLElement,
    private hint: HTMLElement,
  ) {
    this.place = { column: 0, row: orbit.start };
    this.pictures = new Pictures(orbit, start);
    this.canvas = canvasFor(orbit, start.alt);
    this.canvas.addEventListener("pointerdown", (event) => this.down(event));
    this.canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const) this.canvas.addEventListener(end, (event) => this.up(event));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  async begin(): Promise<void> {
    await this.show();
    this.start.replaceWith(this.canvas);
  }

  private async show(): Promise<void> {
    const index = indexOf(this.place, this.orbit);
    if (index === this.wanted) return;
    this.wanted = index;
    const image = await this.pictures.get(index);
    // Another one may be wanted by now.
    if (this.wanted !== index) return;
    const context = this.canvas.getContext("2d") as CanvasRenderingContext2D;
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.drawImage(image, 0, 0, this.canvas.width, this.canvas.height);
    this.canvas.dataset.index = String(index);
    for (const next of around(this.place, this.orbit, REACH)) void this.pictures.get(next);
  }

  /** By degrees of the camera, to the right and up. */
  private turn(right: number, up: number): void {
    const step = rowStep(this.orbit);
    const column = this.place.column + (right * this.orbit.columns) / 360;
    this.place = clamped({ column, row: this.place.row + (step ? up / step : 0) }, this.orbit);
    this.hint.hidden = true;
    void this.show();
  }

  private down(event: PointerEvent): void {
    if (this.grip || event.button !== 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.grip = { id: event.pointerId, x: event.clientX, y: event.clientY };
  }

  private move(event: PointerEvent): void {
    if (this.grip?.id !== event.pointerId) return;
    const scale = DEGREES_PER_HEIGHT / this.canvas.clientHeight;
    this.turn((this.grip.x - event.clientX) * scale, (event.clientY - this.grip.y) * scale);
    this.grip = { id: event.pointerId, x: event.clientX, y: event.clientY };
  }

  private up(event: PointerEvent): void {
    if (this.grip?.id === event.pointerId) this.grip = null;
  }

  private key(event: KeyboardEvent): void {
    const around = 360 / this.orbit.columns;
    const over = rowStep(this.orbit);
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-around, 0],
      ArrowRight: [around, 0],
      ArrowUp: [0, over],
      ArrowDown: [0, -over],
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Home") this.place = { column: 0, row: this.orbit.start };
    const by = event.key === "Home" ? [0, 0] : turns[event.key];
    if (!by) return;
    event.preventDefault();
    this.turn(by[0] as number, by[1] as number);
    this.status.textContent = degrees(this.orbit, indexOf(this.place, this.orbit));
  }
}

function add(parent: Element, tag: string, name: string, text: string): HTMLElement {
  const element = document.createElement(tag);
  element.className = name;
  element.textContent = text;
  parent.append(element);
  return element;
}

const start = document.getElementById("start") as HTMLImageElement;
const orbit = JSON.parse(document.getElementById("orbit")?.textContent ?? "") as Orbit;
const stage = start.parentElement as HTMLElement;
const hint = add(stage, "p", "hint", "Drag to turn");
hint.setAttribute("aria-hidden", "true");
const status = add(stage, "p", "unseen", "");
status.setAttribute("role", "status");
new Turner(orbit, start, status, hint).begin().catch(() => (hint.textContent = "The pictures could not be decoded"));

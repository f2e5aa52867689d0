// Pictures out of the document, decoded when they are needed; the last ones stay.
import type { Orbit } from "./grid";

/** Decoded ones that are kept. */
const MOST_KEPT = 40;

export class Pictures {
  private kept = new Map<number, Promise<HTMLImageElement>>();

  constructor(
    private orbit: Orbit,
    private start: HTMLImageElement,
  ) {}

  get(index: number): Promise<HTMLImageElement> {
    const known = this.kept.get(index) ?? this.load(index);
    // To the end, so that the oldest are first.
    this.kept.delete(index);
    this.kept.set(index, known);
    for (const oldest of this.kept.keys()) {
      if (this.kept.size <= MOST_KEPT) break;
      this.kept.delete(oldest);
    }
    return known;
  }

  private async load(index: number): Promise<HTMLImageElement> {
    const bytes = this.orbit.pictures[index];
    const image = bytes ? new Image() : this.start;
    if (bytes) image.src = `data:${this.orbit.type};base64,${bytes}`;
    await image.decode();
    return image;
  }
}

// What is dragged is sent at frames of the display, the newest only, and no more often than servers take messages.

/** A display may have 240 frames a second and more. */
const GAP_MS = 12;

export class Pace {
  private frame = 0;
  private last = -1e9;
  private call: (() => void) | null = null;

  /** Calls at one of the next frames; what was to be called before is not. */
  later(call: () => void): void {
    this.call = call;
    if (!this.frame) this.frame = requestAnimationFrame(this.step);
  }

  /** What was to be called is called at once. */
  flush(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const { call } = this;
    this.call = null;
    call?.();
  }

  private step = (time: number): void => {
    if (time - this.last < GAP_MS) {
      this.frame = requestAnimationFrame(this.step);
      return;
    }
    this.last = time;
    this.flush();
  };
}

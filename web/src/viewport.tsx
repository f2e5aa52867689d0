import { useEffect, useRef } from "preact/hooks";
import type { Connection } from "./connection";
import { Gestures } from "./gestures";
import { useStore } from "./store";

const RESIZE_MS = 100;
const LARGEST_SIDE = 4096;
const MOST_RATIO = 2;

let pickId = 0;

/** Pixels of the picture for each of the page: for both sides the same, also where the larger one is limited. */
function ratioOf(element: HTMLElement): number {
  const longest = Math.max(1, element.clientWidth, element.clientHeight);
  return Math.min(MOST_RATIO, window.devicePixelRatio || 1, LARGEST_SIDE / longest);
}

function sizeOf(element: HTMLElement): [number, number] {
  const ratio = ratioOf(element);
  const side = (length: number) => Math.max(1, Math.round(length * ratio));
  return [side(element.clientWidth), side(element.clientHeight)];
}

/** `embedded`: in a document that scrolls, where the wheel zooms only when the picture has the focus. */
export function Viewport({ connection, embedded = false }: { connection: Connection; embedded?: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const phase = useStore((state) => state.phase);
  const controls = useStore((state) => state.control.controls);
  useEffect(() => {
    const element = canvas.current as HTMLCanvasElement;
    connection.painter.attach(element);
    // Without a size it is not laid out yet, or no more.
    const measure = () => element.clientWidth > 0 && connection.resize(...sizeOf(element));
    const gestures = new Gestures(element, connection, {
      scale: () => ratioOf(element),
      entered: measure,
      takesWheel: () => !embedded || (element.getRootNode() as ShadowRoot).activeElement === element,
      clicked: (at) => connection.isLive && connection.send({ kind: "pick", id: ++pickId, x: at.x, y: at.y }),
    });
    let timer = 0;
    const observer = new ResizeObserver(() => {
      clearTimeout(timer);
      timer = window.setTimeout(measure, RESIZE_MS);
    });
    measure();
    observer.observe(element);
    const sight = new IntersectionObserver(([last]) => last && connection.seen(element, last.isIntersecting));
    sight.observe(element);
    connection.seen(element, true);
    return () => {
      observer.disconnect();
      sight.disconnect();
      gestures.end();
      connection.painter.detach(element);
      connection.seen(element, undefined);
    };
  }, []);
  const help = "Drag to turn, right drag or two fingers to move, wheel or pinch to zoom, double click to focus. " +
    "Arrow keys turn, plus and minus zoom, W A S D Q E fly, F fits.";
  return (
    <canvas
      ref={canvas}
      class={phase === "live" ? "picture" : "picture stale"}
      tabIndex={0}
      role="application"
      aria-label={controls ? `Rendered view. ${help}` : "Rendered view, watching only"}
    />
  );
}

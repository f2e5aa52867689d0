// What the page knows. One object; parts of the page are drawn again when it changes.
import { useEffect, useState } from "preact/hooks";
import type { Animation, Control, Field, FieldValue, Pick, SceneNode, Statistics } from "./protocol";

export type Phase = "connecting" | "live" | "lost" | "denied" | "full";

export interface Notice {
  id: number;
  text: string;
  error: boolean;
}

export interface State {
  phase: Phase;
  reason: string;
  watches: boolean;
  control: Control;
  fields: Field[];
  values: Record<string, FieldValue>;
  channels: string[];
  channel: string;
  nodes: SceneNode[];
  selected: string;
  camera: string;
  statistics: Statistics | null;
  animation: Animation | null;
  pick: Pick | null;
  notices: Notice[];
  /** Of the last seconds: what came, and how long an input took to be seen. */
  rate: { fps: number; kbytes: number; inputMs: number };
  exact: boolean;
}

type Listener = () => void;

const listeners = new Set<Listener>();

export const state: State = {
  phase: "connecting",
  reason: "",
  watches: false,
  control: { controls: false, taken: false, may: false, clients: 0 },
  fields: [],
  values: {},
  channels: [],
  channel: "picture",
  nodes: [],
  selected: "",
  camera: "",
  statistics: null,
  animation: null,
  pick: null,
  notices: [],
  rate: { fps: 0, kbytes: 0, inputMs: 0 },
  exact: false,
};

let scheduled = false;

export function update(change: Partial<State>): void {
  Object.assign(state, change);
  if (scheduled) return;
  scheduled = true;
  queueMicrotask(() => {
    scheduled = false;
    for (const listener of listeners) listener();
  });
}

/** The state; the component is drawn again when what `part` picks out of it is another thing. */
export function useStore<T>(part: (state: State) => T): T {
  const [value, setValue] = useState(() => part(state));
  useEffect(() => {
    const listener = () => setValue(() => part(state));
    listeners.add(listener);
    listener();
    return () => void listeners.delete(listener);
  }, []);
  return value;
}

let noticeId = 0;

export function notify(text: string, error = false): void {
  const notice = { id: ++noticeId, text, error };
  const others = state.notices.filter((other) => other.text !== text);
  update({ notices: [...others, notice].slice(-4) });
  setTimeout(() => dismiss(notice.id), error ? 12000 : 5000);
}

export function dismiss(id: number): void {
  update({ notices: state.notices.filter((notice) => notice.id !== id) });
}

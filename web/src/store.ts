// What the page knows of a view. One object; parts of the page are drawn again when it changes.
import { createContext } from "preact";
import { useContext, useEffect, useState } from "preact/hooks";
import type { Animation, Control, Field, FieldValue, Pick, SceneNode, Statistics, UserPanel, Widget } from "./protocol";

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
  panels: UserPanel[];
  /** Panels of the server's own, by name. */
  tools: Record<string, Widget[]>;
  notices: Notice[];
  /** Of the last seconds: what came, and how long an input took to be seen. */
  rate: { fps: number; kbytes: number; inputMs: number };
  exact: boolean;
  /** Of moving pictures. */
  codec: string;
  /** A picture has been drawn. */
  drawn: boolean;
}

type Listener = () => void;

const begin = (): State => ({
  phase: "connecting",
  reason: "",
  watches: false,
  control: { controls: false, taken: false, may: false, clients: 0, view: 0, own: false },
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
  panels: [],
  tools: {},
  notices: [],
  rate: { fps: 0, kbytes: 0, inputMs: 0 },
  exact: false,
  codec: "",
  drawn: false,
});

export class Store {
  readonly state = begin();
  private listeners = new Set<Listener>();
  private scheduled = false;
  private notices = 0;

  update(change: Partial<State>): void {
    Object.assign(this.state, change);
    if (this.scheduled) return;
    this.scheduled = true;
    queueMicrotask(() => {
      this.scheduled = false;
      for (const listener of this.listeners) listener();
    });
  }

  /** Returns what ends it. */
  listen(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => void this.listeners.delete(listener);
  }

  notify(text: string, error = false): void {
    const notice = { id: ++this.notices, text, error };
    const others = this.state.notices.filter((other) => other.text !== text);
    this.update({ notices: [...others, notice].slice(-4) });
    setTimeout(() => this.dismiss(notice.id), error ? 12000 : 5000);
  }

  dismiss(id: number): void {
    this.update({ notices: this.state.notices.filter((notice) => notice.id !== id) });
  }
}

/** Of the view that a component belongs to: a page may hold several. */
export const StoreContext = createContext(new Store());

export const useWholeStore = (): Store => useContext(StoreContext);

/** The state; the component is drawn again when what `part` picks out of it is another thing. */
export function useStore<T>(part: (state: State) => T): T {
  const store = useWholeStore();
  const [value, setValue] = useState(() => part(store.state));
  useEffect(() => {
    const listener = () => setValue(() => part(store.state));
    listener();
    return store.listen(listener);
  }, []);
  return value;
}

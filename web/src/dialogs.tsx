import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { formatFragment, tokenOf } from "./link";
import { useStore } from "./store";

function Dialog({ title, close, children }: { title: string; close: () => void; children: ComponentChildren }) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  return (
    <dialog ref={dialog} aria-labelledby="dialog-title" onClose={close}>
      <h2 id="dialog-title">{title}</h2>
      {children}
    </dialog>
  );
}

const LARGEST = 16384;
const MOST_PIXELS = 2 ** 26;

export function ShotDialog({ connection, close }: { connection: Connection; close: () => void }) {
  const last = connection.painter.last;
  const [width, setWidth] = useState(last?.width ?? 1280);
  const [height, setHeight] = useState(last?.height ?? 720);
  const fits = width >= 1 && height >= 1 && Math.max(width, height) <= LARGEST && width * height <= MOST_PIXELS;
  const take = (event: Event) => {
    event.preventDefault();
    if (!fits) return;
    connection.send({ kind: "shot", id: 1, width, height });
    connection.store.notify("The picture is drawn, then it is downloaded");
    close();
  };
  const preset = (factor: number) => () => {
    setWidth(Math.round((last?.width ?? 1280) * factor));
    setHeight(Math.round((last?.height ?? 720) * factor));
  };
  const side = (label: string, value: number, set: (value: number) => void) => (
    <label>
      {label}
      <input type="number" min={1} max={LARGEST} value={value} onInput={(event) => set(Math.round(Number(event.currentTarget.value)))} />
    </label>
  );
  return (
    <Dialog title="Screenshot" close={close}>
      <form onSubmit={take}>
        <div class="sides">
          {side("Width", width, setWidth)}
          {side("Height", height, setHeight)}
        </div>
        <div class="presets">
          {[1, 2, 4].map((factor) => (
            <button key={factor} type="button" onClick={preset(factor)}>
              {factor}×
            </button>
          ))}
          <button type="button" onClick={() => (setWidth(3840), setHeight(2160))}>
            4K
          </button>
        </div>
        {!fits && <p class="hint">Sides are at most {LARGEST}, pixels 67 million.</p>}
        <div class="actions">
          <button type="button" onClick={close}>
            Cancel
          </button>
          <button type="submit" class="primary" disabled={!fits}>
            Download PNG
          </button>
        </div>
      </form>
    </Dialog>
  );
}

export function ShareDialog({ connection, close }: { connection: Connection; close: () => void }) {
  const camera = useStore((store) => store.camera);
  const [secret, setSecret] = useState(false);
  const settings = connection.settings;
  const fragment = formatFragment({ token: secret ? connection.token : "", camera, settings });
  const link = location.origin + location.pathname + fragment;
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(link);
      connection.store.notify("The link is on the clipboard");
      close();
    } catch {
      connection.store.notify("The browser does not let pages copy here: copy the text by hand", true);
    }
  };
  return (
    <Dialog title="Link to this view" close={close}>
      <p class="hint">It holds the camera and the settings that were changed here.</p>
      <textarea readOnly rows={4} aria-label="Link" value={link} onFocus={(event) => event.currentTarget.select()} />
      <label class="check">
        <input type="checkbox" checked={secret} onChange={(event) => setSecret(event.currentTarget.checked)} />
        With the secret: who has this link {connection.store.state.watches ? "can watch" : "can control"}
      </label>
      <div class="actions">
        <button type="button" onClick={close}>
          Close
        </button>
        <button type="button" class="primary" onClick={copy}>
          Copy
        </button>
      </div>
    </Dialog>
  );
}

export function TokenForm({ connection }: { connection: Connection }) {
  const reason = useStore((store) => store.reason);
  const [text, setText] = useState("");
  const enter = (event: Event) => {
    event.preventDefault();
    const token = tokenOf(text);
    if (token) connection.useToken(token);
  };
  return (
    <main class="token">
      <form onSubmit={enter}>
        <img src="icon.svg" alt="" width="48" height="48" />
        <h1>EasyPBR</h1>
        <p>{reason || "This page needs the secret that the server printed."}</p>
        <input
          type="password"
          aria-label="Link or secret"
          placeholder="Link or secret"
          autocomplete="off"
          value={text}
          onInput={(event) => setText(event.currentTarget.value)}
        />
        <button type="submit" class="primary">
          Open
        </button>
      </form>
    </main>
  );
}

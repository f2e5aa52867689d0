import { useState } from "preact/hooks";
import type { Dialog } from "./app";
import type { Connection } from "./connection";
import { IconButton } from "./icons";
import { useStore } from "./store";
import { setTheme, theme } from "./theme";

const readable = (name: string) => name.replaceAll("_", " ");

function Channels({ connection }: { connection: Connection }) {
  const channels = useStore((state) => state.channels);
  const channel = useStore((state) => state.channel);
  const controls = useStore((state) => state.control.controls);
  return (
    <select
      class="channels"
      aria-label="Channel"
      title="Channel"
      value={channel}
      disabled={!controls}
      onChange={(event) => connection.send({ kind: "channel", name: event.currentTarget.value })}
    >
      {channels.map((name) => (
        <option key={name} value={name}>
          {readable(name)}
        </option>
      ))}
    </select>
  );
}

function ControlButton({ connection }: { connection: Connection }) {
  const control = useStore((state) => state.control);
  const others = control.clients > 1 ? `${control.clients} clients` : "";
  if (control.view) return null;
  if (control.controls)
    return others ? (
      <button type="button" class="pill" title="Let somebody else control" onClick={() => connection.send({ kind: "act", what: "leave" })}>
        You control · {others}
      </button>
    ) : null;
  if (!control.may) return <span class="pill quiet">Watching</span>;
  return (
    <button type="button" class="pill" onClick={() => connection.send({ kind: "act", what: "take" })}>
      {control.taken ? "Ask for control" : "Take control"}
    </button>
  );
}

/** Another camera and other settings for this page alone, and back. */
function OwnViewButton({ connection }: { connection: Connection }) {
  const control = useStore((state) => state.control);
  if (!control.own) return null;
  const isOwn = control.view !== 0;
  return (
    <button
      type="button"
      class="pill own"
      aria-pressed={isOwn}
      title={isOwn ? "Back to the view that all share" : "A camera and settings for this page alone"}
      onClick={() => connection.lookAt(!isOwn)}
    >
      Own view
    </button>
  );
}

export function Toolbar(props: {
  connection: Connection;
  open: boolean;
  setOpen: (open: boolean) => void;
  show: (dialog: Dialog) => void;
  title: string;
}) {
  const { connection } = props;
  const controls = useStore((state) => state.control.controls);
  const [shade, setShade] = useState(theme());
  const act = (what: string) => () => connection.send({ kind: "act", what });
  const turn = () => {
    const next = shade === "dark" ? "light" : "dark";
    setTheme(next);
    setShade(next);
  };
  const fullScreen = () => {
    if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
    else document.documentElement.requestFullscreen().catch(() => {});
  };
  return (
    <header class="toolbar">
      <img class="logo" src="icon.svg" alt="" width="24" height="24" />
      <span class="brand">EasyPBR</span>
      <span class="title">{props.title}</span>
      <ControlButton connection={connection} />
      <OwnViewButton connection={connection} />
      <Channels connection={connection} />
      <nav class="tools" aria-label="Tools">
        <IconButton icon="fit" label="Show everything" keys="F" disabled={!controls} onClick={act("fit")} />
        <IconButton icon="undo" label="Undo" keys="Ctrl+Z" disabled={!controls} onClick={act("undo")} />
        <IconButton icon="redo" label="Redo" keys="Ctrl+Y" disabled={!controls} onClick={act("redo")} />
        <IconButton icon="camera" label="Screenshot" disabled={!controls} onClick={() => props.show("shot")} />
        <IconButton icon="link" label="Link to this view" onClick={() => props.show("share")} />
        <IconButton icon={shade === "dark" ? "sun" : "moon"} label={shade === "dark" ? "Light theme" : "Dark theme"} onClick={turn} />
        <IconButton icon="full" label="Full screen" onClick={fullScreen} />
        <IconButton icon="panel" label="Controls" pressed={props.open} onClick={() => props.setOpen(!props.open)} />
      </nav>
    </header>
  );
}

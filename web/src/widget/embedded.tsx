import { useEffect, useRef, useState } from "preact/hooks";
import { AnimationBar } from "../animation";
import type { Connection } from "../connection";
import { ShotDialog } from "../dialogs";
import { IconButton } from "../icons";
import { Notices, ReadOut } from "../overlays";
import { Panel } from "../panel";
import { useStore } from "../store";
import { Viewport } from "../viewport";
import { PATIENCE_MS } from "./comm";

/** What was saved with the notebook, until a picture comes. */
function Still({ picture }: { picture: string }) {
  const drawn = useStore((state) => state.drawn);
  return drawn || !picture ? null : <img class="still" src={picture} alt="The view as it was when the notebook was saved" />;
}

function Silence() {
  const phase = useStore((state) => state.phase);
  const reason = useStore((state) => state.reason);
  const [late, setLate] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setLate(true), PATIENCE_MS);
    return () => clearTimeout(timer);
  }, []);
  if (phase === "live" || !late) return null;
  return (
    <p class="pill silence" role="status">
      {reason || "The kernel is busy, or there is none: this picture stands still"}
    </p>
  );
}

function Tools(props: { connection: Connection; open: boolean; setOpen: (open: boolean) => void; shoot: () => void; whole: () => void }) {
  const { connection } = props;
  const controls = useStore((state) => state.control.controls);
  const act = (what: string) => () => connection.send({ kind: "act", what });
  return (
    <nav class="tools floating" aria-label="Tools">
      <IconButton icon="fit" label="Show everything" keys="F" disabled={!controls} onClick={act("fit")} />
      <IconButton icon="undo" label="Undo" keys="Ctrl+Z" disabled={!controls} onClick={act("undo")} />
      <IconButton icon="redo" label="Redo" keys="Ctrl+Y" disabled={!controls} onClick={act("redo")} />
      <IconButton icon="camera" label="Screenshot" disabled={!controls} onClick={props.shoot} />
      <IconButton icon="full" label="Full screen" onClick={props.whole} />
      <IconButton icon="panel" label="Controls" pressed={props.open} onClick={() => props.setOpen(!props.open)} />
    </nav>
  );
}

export function Embedded({ connection, picture, label }: { connection: Connection; picture: string; label: string }) {
  const [open, setOpen] = useState(false);
  const [shooting, setShooting] = useState(false);
  const layout = useRef<HTMLElement>(null);
  const whole = () => {
    if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
    else layout.current?.requestFullscreen().catch(() => {});
  };
  return (
    <section ref={layout} class={open ? "layout embedded open" : "layout embedded"} aria-label={label}>
      <div class="stage">
        <Still picture={picture} />
        <Viewport connection={connection} embedded />
        <ReadOut />
        <Silence />
        <AnimationBar connection={connection} />
        <Tools connection={connection} open={open} setOpen={setOpen} shoot={() => setShooting(true)} whole={whole} />
      </div>
      {open && <Panel connection={connection} hide={() => setOpen(false)} />}
      <Notices />
      {shooting && <ShotDialog connection={connection} close={() => setShooting(false)} />}
    </section>
  );
}

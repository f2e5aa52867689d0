import { useEffect, useState } from "preact/hooks";
import { AnimationBar } from "./animation";
import type { Connection } from "./connection";
import { ShareDialog, ShotDialog, TokenForm } from "./dialogs";
import { Notices, ReadOut, Status } from "./overlays";
import { Panel } from "./panel";
import { useStore } from "./store";
import { Toolbar } from "./toolbar";
import { Viewport } from "./viewport";

export type Dialog = "share" | "shot" | null;

export function App({ connection }: { connection: Connection }) {
  const phase = useStore((state) => state.phase);
  const title = useStore((state) => state.nodes.map((node) => node.path).join(", "));
  const [open, setOpen] = useState(window.innerWidth > 700);
  const [dialog, setDialog] = useState<Dialog>(null);
  useEffect(() => {
    document.title = title ? `${title.slice(0, 60)} - EasyPBR` : "EasyPBR";
  }, [title]);
  if (phase === "denied") return <TokenForm connection={connection} />;
  return (
    <div class={open ? "layout open" : "layout"}>
      <Toolbar connection={connection} open={open} setOpen={setOpen} show={setDialog} title={title} />
      <main class="stage">
        <h1 class="unseen">EasyPBR view</h1>
        <Viewport connection={connection} />
        <ReadOut />
        <Status connection={connection} />
        <AnimationBar connection={connection} />
      </main>
      {open && <Panel connection={connection} hide={() => setOpen(false)} />}
      <Notices />
      {dialog === "shot" && <ShotDialog connection={connection} close={() => setDialog(null)} />}
      {dialog === "share" && <ShareDialog connection={connection} close={() => setDialog(null)} />}
    </div>
  );
}

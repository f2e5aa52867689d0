import { useEffect, useState } from "preact/hooks";
import { AnimationBar } from "./animation";
import type { Connection } from "./connection";
import { ShareDialog, ShotDialog, TokenForm } from "./dialogs";
import { Notices, ReadOut, Status } from "./overlays";
import { ScenePanel } from "./scene";
import { SettingsPanel } from "./settings";
import { StatisticsPanel } from "./statistics";
import { useStore } from "./store";
import { Toolbar } from "./toolbar";
import { Viewport } from "./viewport";

export type Dialog = "share" | "shot" | null;

const TABS = ["Scene", "Settings", "Statistics"] as const;
type Tab = (typeof TABS)[number];

function Panel({ connection, hide }: { connection: Connection; hide: () => void }) {
  const [tab, setTab] = useState<Tab>("Scene");
  const move = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (!step) return;
    const next = TABS[(TABS.indexOf(tab) + step + TABS.length) % TABS.length] as Tab;
    setTab(next);
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <aside class="panel" aria-label="Controls">
      <div class="tabs">
        <div role="tablist" aria-label="Controls" class="tab-list" onKeyDown={move}>
          {TABS.map((name) => (
            <button
              key={name}
              id={`tab-${name}`}
              type="button"
              role="tab"
              aria-selected={tab === name}
              aria-controls="tab-content"
              tabIndex={tab === name ? 0 : -1}
              onClick={() => setTab(name)}
            >
              {name}
            </button>
          ))}
        </div>
        <button type="button" class="sheet-close" onClick={hide}>
          Done
        </button>
      </div>
      <div id="tab-content" role="tabpanel" aria-labelledby={`tab-${tab}`} class="tab-content" tabIndex={0}>
        {tab === "Scene" && <ScenePanel connection={connection} />}
        {tab === "Settings" && <SettingsPanel connection={connection} />}
        {tab === "Statistics" && <StatisticsPanel />}
      </div>
    </aside>
  );
}

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

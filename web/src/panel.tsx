import { useState } from "preact/hooks";
import type { Connection } from "./connection";
import { ScenePanel } from "./scene";
import { SettingsPanel } from "./settings";
import { StatisticsPanel } from "./statistics";
import { useStore } from "./store";
import { Tool, UserPanels } from "./user_panels";

const TABS = ["Panels", "Scene", "Camera", "Settings", "Statistics"] as const;
type Tab = (typeof TABS)[number];

/** Everything beside the picture, in tabs. */
export function Panel({ connection, hide }: { connection: Connection; hide: () => void }) {
  const [chosen, setTab] = useState<Tab | null>(null);
  const hasPanels = useStore((state) => state.panels.length > 0);
  const tabs = TABS.filter((name) => hasPanels || name !== "Panels");
  const tab = chosen && tabs.includes(chosen) ? chosen : (tabs[0] as Tab);
  const move = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (!step) return;
    const next = tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length] as Tab;
    setTab(next);
    (event.currentTarget as HTMLElement).querySelector<HTMLElement>(`#tab-${next}`)?.focus();
  };
  return (
    <aside class="panel" aria-label="Controls">
      <div class="tabs">
        <div role="tablist" aria-label="Controls" class="tab-list" onKeyDown={move}>
          {tabs.map((name) => (
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
        {tab === "Panels" && <UserPanels connection={connection} />}
        {tab === "Scene" && (
          <>
            <Tool name="Files" connection={connection} />
            <ScenePanel connection={connection} />
            <Tool name="Object" connection={connection} />
            <Tool name="Lights" connection={connection} />
          </>
        )}
        {tab === "Camera" && (
          <>
            <Tool name="Camera path" connection={connection} />
            <Tool name="Recording" connection={connection} />
          </>
        )}
        {tab === "Settings" && <SettingsPanel connection={connection} />}
        {tab === "Statistics" && <StatisticsPanel />}
      </div>
    </aside>
  );
}

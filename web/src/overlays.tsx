import type { Connection } from "./connection";
import { IconButton } from "./icons";
import { useStore, useWholeStore } from "./store";

export function Notices() {
  const store = useWholeStore();
  const notices = useStore((state) => state.notices);
  return (
    <div class="notices" role="status" aria-live="polite">
      {notices.map((notice) => (
        <div key={notice.id} class={notice.error ? "notice error" : "notice"}>
          <span>{notice.text}</span>
          <IconButton icon="close" label="Dismiss" onClick={() => store.dismiss(notice.id)} />
        </div>
      ))}
    </div>
  );
}

const number = (value: number) => String(Number(value.toPrecision(6)));

/** What was clicked. */
export function ReadOut() {
  const store = useWholeStore();
  const pick = useStore((state) => state.pick);
  if (!pick?.hit) return null;
  const values = pick.values ?? {};
  const rows: [string, string][] = [
    [pick.face ? "face" : "vertex", String(pick.element)],
    ["position", (pick.position ?? []).map(number).join(", ")],
    ["depth", number(pick.depth ?? 0)],
  ];
  if (pick.part) rows.unshift(["part", pick.part]);
  if (values.label !== undefined) rows.push(["label", values.class ? `${values.label} ${values.class}` : String(values.label)]);
  for (const [name, value] of Object.entries(values.scalars ?? {})) rows.push([name, number(value)]);
  return (
    <section class="read-out" aria-label="Picked">
      <div class="head">
        <strong>{pick.object}</strong>
        <IconButton icon="close" label="Close the read-out" onClick={() => store.update({ pick: null })} />
      </div>
      <dl>
        {rows.map(([name, value]) => (
          <div key={name} class="item">
            <dt>{name}</dt>
            <dd class="number">{value}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}

export function Status({ connection }: { connection: Connection }) {
  const phase = useStore((state) => state.phase);
  const reason = useStore((state) => state.reason);
  const statistics = useStore((state) => state.statistics);
  if (phase === "live") {
    const refines = statistics !== null && statistics.frames < statistics.total;
    return refines ? <progress class="refining" max={statistics.total} value={statistics.frames} aria-label="Refinement" /> : null;
  }
  const texts = { connecting: "Connecting …", lost: "Connection lost, trying again …", full: "The server has no room for another client", denied: "" };
  return (
    <div class="status" role="status">
      <span>
        {texts[phase]}
        {reason && <small>{reason}</small>}
      </span>
      <button type="button" onClick={() => connection.retry()}>
        Try now
      </button>
    </div>
  );
}

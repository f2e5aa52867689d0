import { useStore } from "./store";

function Item({ name, value, doc }: { name: string; value: string; doc?: string }) {
  return (
    <div class="item" title={doc}>
      <dt>{name}</dt>
      <dd class="number">{value}</dd>
    </div>
  );
}

export function StatisticsPanel() {
  const statistics = useStore((state) => state.statistics);
  const rate = useStore((state) => state.rate);
  const exact = useStore((state) => state.exact);
  const codec = useStore((state) => state.codec);
  const control = useStore((state) => state.control);
  if (!statistics) return <p class="hint">Nothing is known yet.</p>;
  return (
    <dl class="items">
      <Item name="Picture" value={`${statistics.width} × ${statistics.height}`} doc="Size of the last picture; smaller while it moves on slow machines or lines" />
      <Item name="Samples" value={`${statistics.frames} of ${statistics.total}`} doc="Frames that are averaged, of those that shall be" />
      <Item name="Shown" value={exact ? "exact" : "preview"} doc="Exact: lossless, what is rendered to a file bit for bit" />
      <Item name="Frame time" value={`${statistics.frame_ms.toFixed(1)} ms`} doc="What the last frame took to draw" />
      <Item name="Pictures" value={`${rate.fps.toFixed(1)} /s`} doc="That have come, over the last two seconds" />
      {codec && <Item name="Moving" value={codec} doc="What moving pictures come as" />}
      <Item name="Data" value={`${((rate.kbytes * 8) / 1000).toFixed(1)} Mbit/s`} />
      <Item name="Wire" value={`${statistics.latency_ms.toFixed(0)} ms`} doc="From sending a picture to who controls until it says that it is drawn" />
      <Item name="Input to picture" value={`${rate.inputMs.toFixed(0)} ms`} doc="Median, from an input of yours to a picture that shows it" />
      <Item name="Quality" value={`${Math.round(statistics.share * 100)} %`} doc="Of moving pictures: less on a slow line" />
      <Item name="Renderer" value={statistics.software ? "software" : "GPU"} />
      <Item name="Clients" value={String(control.clients)} />
    </dl>
  );
}

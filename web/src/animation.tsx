import type { Connection } from "./connection";
import { Icon } from "./icons";
import { useStore } from "./store";

/** Plays the animations of the files that are served; absent without any. */
export function AnimationBar({ connection }: { connection: Connection }) {
  const animation = useStore((state) => state.animation);
  const controls = useStore((state) => state.control.controls);
  if (!animation) return null;
  const time = animation.time;
  const send = (change: { number?: number; plays?: boolean; time?: number; speed?: number }) =>
    connection.send({
      kind: "animate",
      number: animation.current,
      plays: animation.plays,
      time,
      speed: animation.speed,
      ...change,
    });
  return (
    <div class="animation" role="group" aria-label="Animation">
      <button
        type="button"
        class="icon-button"
        disabled={!controls}
        aria-label={animation.plays ? "Pause" : "Play"}
        onClick={() => send({ plays: !animation.plays })}
      >
        <Icon name={animation.plays ? "pause" : "play"} />
      </button>
      <select
        aria-label="Animation"
        value={animation.current}
        disabled={!controls}
        onChange={(event) => send({ number: Number(event.currentTarget.value), time: 0 })}
      >
        {animation.names.map((name, index) => (
          <option key={index} value={index}>
            {name}
          </option>
        ))}
      </select>
      <input
        type="range"
        aria-label="Time in seconds"
        min={0}
        max={animation.duration}
        step={animation.duration / 500 || 0.01}
        value={time}
        disabled={!controls}
        onInput={(event) => send({ time: Number(event.currentTarget.value) })}
      />
      <span class="number">{time.toFixed(1)} s</span>
    </div>
  );
}

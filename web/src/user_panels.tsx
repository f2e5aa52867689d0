// Panels of the program that serves the view, and those that the server itself has.
import type { Connection } from "./connection";
import { Control } from "./field";
import { FieldRow } from "./field_row";
import type { Field, UserPanel, Widget } from "./protocol";
import { useStore } from "./store";

const PLOT_WIDTH = 300;
const PLOT_HEIGHT = 64;
const FIELD_TYPES: Record<string, Field["type"]> = { checkbox: "boolean", slider: "number", number: "number", color: "color" };

/** Points of an SVG's lines; what is not a number ends one and begins another. */
function linesOf(values: (number | null)[], low: number, high: number): string[] {
  const lines: string[][] = [[]];
  values.forEach((value, index) => {
    if (value === null) return void lines.push([]);
    const x = (index / Math.max(1, values.length - 1)) * PLOT_WIDTH;
    const part = Math.max(0, Math.min(1, (value - low) / (high - low)));
    lines[lines.length - 1]?.push(`${x.toFixed(1)},${((1 - part) * PLOT_HEIGHT).toFixed(1)}`);
  });
  return lines.filter((line) => line.length > 0).map((line) => line.join(" "));
}

function Plot({ widget }: { widget: Widget }) {
  const last = widget.last === undefined ? "" : String(Number(widget.last.toPrecision(4)));
  return (
    <figure class="plot">
      <figcaption>
        {widget.name} <span class="number">{last}</span>
      </figcaption>
      <svg viewBox={`0 -2 ${PLOT_WIDTH} ${PLOT_HEIGHT + 4}`} preserveAspectRatio="none" role="img" aria-label={`${widget.name}: ${last}`}>
        {linesOf(widget.values ?? [], widget.min as number, widget.max as number).map((points) => (
          <polyline points={points} />
        ))}
      </svg>
    </figure>
  );
}

interface Props {
  widget: Widget;
  id: string;
  disabled: boolean;
  set: (value: string) => void;
}

function Row({ widget, id, disabled, set }: Props) {
  const field: Field = {
    name: widget.name,
    doc: "",
    type: FIELD_TYPES[widget.type] ?? "text",
    ...(widget.type === "slider" && { min: widget.min, max: widget.max, slider: true }),
    whole: widget.whole,
    choices: widget.choices,
  };
  return (
    <div class="row">
      <label for={id}>{widget.name}</label>
      <div class="control">
        <Control field={field} id={id} label={widget.name} value={String(widget.value)} disabled={disabled} set={set} />
      </div>
    </div>
  );
}

function Shown(props: Props) {
  const { widget, disabled, set } = props;
  switch (widget.type) {
    case "text":
      return <p class="words">{widget.name}</p>;
    case "separator":
      return <hr />;
    case "button":
      return (
        <button type="button" class="wide-button" disabled={disabled} onClick={() => set("")}>
          {widget.name}
        </button>
      );
    case "section":
      return (
        <button
          type="button"
          class={widget.value ? "fold section open" : "fold section"}
          aria-expanded={widget.value === true}
          disabled={disabled}
          onClick={() => set(String(!widget.value))}
        >
          {widget.name}
        </button>
      );
    case "progress":
      return (
        <div class="progress">
          <progress value={Number(widget.value)} aria-label={widget.name || "Progress"} />
          <span>{widget.name}</span>
        </div>
      );
    case "field":
      return (
        <FieldRow
          field={widget.field as Field}
          id={props.id}
          label={widget.name}
          value={String(widget.value)}
          latched={widget.latched}
          disabled={disabled}
          set={set}
        />
      );
    case "plot":
      return <Plot widget={widget} />;
    default:
      return <Row {...props} />;
  }
}

/** Widgets that stand beside the one before are in one line with it. */
function linesOfWidgets(widgets: Widget[]): { widget: Widget; at: number }[][] {
  const lines: { widget: Widget; at: number }[][] = [];
  widgets.forEach((widget, at) => {
    const line = lines[lines.length - 1];
    if (widget.beside && line) line.push({ widget, at });
    else lines.push([{ widget, at }]);
  });
  return lines;
}

function Widgets({ panel, kind, connection }: { panel: UserPanel; kind: "widget" | "tool"; connection: Connection }) {
  const controls = useStore((state) => state.control.controls);
  return (
    <section class="user-panel">
      <h2>{panel.name}</h2>
      {linesOfWidgets(panel.widgets).map((line) => (
        <div class={line.length > 1 ? "line" : undefined} key={line[0]?.at}>
          {line.map(({ widget, at }) => (
            <Shown
              key={`${at} ${widget.type} ${widget.name}`}
              widget={widget}
              id={`${kind}-${panel.name.replaceAll(" ", "-")}-${at}`}
              disabled={!controls}
              set={(value) => connection.send({ kind, panel: panel.name, name: widget.name, use: widget.use ?? 0, value })}
            />
          ))}
        </div>
      ))}
      {panel.error && <pre class="failure">{panel.error}</pre>}
    </section>
  );
}

export function UserPanels({ connection }: { connection: Connection }) {
  const panels = useStore((state) => state.panels);
  return (
    <>
      {panels.map((panel) => (
        <Widgets key={panel.name} panel={panel} kind="widget" connection={connection} />
      ))}
    </>
  );
}

/** One of the server's own. */
export function Tool({ name, connection }: { name: string; connection: Connection }) {
  const widgets = useStore((state) => state.tools[name]);
  return widgets ? <Widgets panel={{ name, widgets }} kind="tool" connection={connection} /> : null;
}

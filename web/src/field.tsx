// One control for each type of setting; values are texts as on the command line.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Field } from "./protocol";

interface Props {
  field: Field;
  id: string;
  label: string;
  value: string;
  disabled: boolean;
  set: (text: string) => void;
}

/** A value that is being typed or dragged stays as it is, whatever the server says meanwhile. */
function useDraft(value: string): [string, (text: string) => void, (editing: boolean) => void] {
  const [draft, setDraft] = useState(value);
  const editing = useRef(false);
  useEffect(() => {
    if (!editing.current) setDraft(value);
  }, [value]);
  const edit = (is: boolean) => {
    editing.current = is;
    if (!is) setDraft(value);
  };
  return [draft, setDraft, edit];
}

function TextControl({ field, id, label, value, disabled, set }: Props) {
  const [draft, setDraft, edit] = useDraft(value);
  const commit = () => {
    if (draft !== value) set(draft);
    edit(false);
  };
  return (
    <input
      id={id}
      aria-label={label}
      type="text"
      inputMode={field.type === "number" || field.type === "integer" ? "decimal" : "text"}
      class={field.type === "vector" ? "wide" : ""}
      value={draft}
      disabled={disabled}
      spellcheck={false}
      autocomplete="off"
      onFocus={() => edit(true)}
      onInput={(event) => setDraft(event.currentTarget.value)}
      onBlur={commit}
      onKeyDown={(event) => {
        if (event.key === "Enter") event.currentTarget.blur();
      }}
    />
  );
}

/** Ranges that a slider makes sense for. */
function hasSlider(field: Field): boolean {
  if (field.min === undefined || field.max === undefined) return false;
  return field.slider || field.max - field.min <= (field.type === "integer" || field.whole ? 64 : 720);
}

/** What has no end stays a word. */
function short(value: number | string): string {
  const number = Number(value);
  return Number.isFinite(number) ? String(Number(number.toPrecision(5))) : String(value);
}

function NumberControl(props: Props) {
  const { field, id, value, disabled, set } = props;
  const [draft, setDraft, edit] = useDraft(value);
  const pending = useRef(0);
  if (!hasSlider(field)) return <TextControl {...props} value={value === "" ? "" : short(value)} />;
  const low = field.min as number;
  const high = field.max as number;
  const whole = field.type === "integer" || field.whole;
  const change = (text: string) => {
    setDraft(text);
    cancelAnimationFrame(pending.current);
    pending.current = requestAnimationFrame(() => set(text));
  };
  return (
    <>
      <input
        id={id}
        type="range"
        min={low}
        max={high}
        step={whole ? 1 : (high - low) / 1000}
        value={draft === "" ? low : draft}
        disabled={disabled}
        onPointerDown={() => edit(true)}
        onInput={(event) => change(short(Number(event.currentTarget.value)))}
        onChange={() => edit(false)}
      />
      <TextControl {...props} id={`${id}-number`} value={draft === "" ? "" : short(draft)} />
    </>
  );
}

/** "#rrggbb" of "#rrggbb", or of three numbers. */
function hexOf(value: string): string {
  if (/^#[0-9a-f]{6}$/i.test(value)) return value;
  const numbers = value.split(",").map(Number);
  if (numbers.length !== 3 || numbers.some(Number.isNaN)) return "#000000";
  const byte = (n: number) => Math.round(Math.max(0, Math.min(1, n)) * 255).toString(16).padStart(2, "0");
  return "#" + numbers.map(byte).join("");
}

function ColorControl({ id, value, disabled, set }: Props) {
  const pending = useRef(0);
  const later = (text: string) => {
    cancelAnimationFrame(pending.current);
    pending.current = requestAnimationFrame(() => set(text));
  };
  return <input id={id} type="color" value={hexOf(value)} disabled={disabled} onInput={(event) => later(event.currentTarget.value)} />;
}

function ChoiceControl({ field, id, value, disabled, set }: Props) {
  return (
    <select id={id} value={value} disabled={disabled} onChange={(event) => set(event.currentTarget.value)}>
      {!(field.choices ?? []).includes(value) && <option value={value}>{value || "automatic"}</option>}
      {(field.choices ?? []).map((choice) => (
        <option key={choice} value={choice}>
          {choice.replaceAll("_", " ")}
        </option>
      ))}
    </select>
  );
}

export function Control(props: Props) {
  const { field, id, value, disabled, set } = props;
  if (field.choices) return <ChoiceControl {...props} />;
  switch (field.type) {
    case "boolean":
      return (
        <input
          id={id}
          type="checkbox"
          role="switch"
          checked={value === "true"}
          disabled={disabled}
          onChange={(event) => set(String(event.currentTarget.checked))}
        />
      );
    case "integer":
    case "number":
      return <NumberControl {...props} />;
    case "color":
      return <ColorControl {...props} />;
    default:
      return <TextControl {...props} />;
  }
}

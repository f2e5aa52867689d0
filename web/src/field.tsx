// One control for each type of setting; values are texts as on the command line.
import { useEffect, useRef, useState } from "preact/hooks";
import { Pace } from "./pace";
import { MOST_TEXT, type Field } from "./protocol";

interface Props {
  field: Field;
  id: string;
  label: string;
  value: string;
  disabled: boolean;
  set: (text: string) => void;
}

interface Draft {
  text: string;
  set: (text: string) => void;
  begin: () => void;
  end: () => void;
  /** Since it began, by the user. */
  isChanged: () => boolean;
}

/** A value that is being typed or dragged stays as it is, whatever the server says meanwhile. */
function useDraft(value: string): Draft {
  const [text, set] = useState(value);
  const first = useRef<string | null>(null);
  useEffect(() => {
    if (first.current === null) set(value);
  }, [value]);
  const begin = () => {
    first.current = text;
  };
  const end = () => {
    first.current = null;
    set(value);
  };
  return { text, set, begin, end, isChanged: () => first.current !== null && text !== first.current };
}

function usePace(): Pace {
  const [pace] = useState(() => new Pace());
  return pace;
}

function TextControl({ field, id, label, value, disabled, set }: Props) {
  const draft = useDraft(value);
  const commit = () => {
    if (draft.isChanged()) set(draft.text);
    draft.end();
  };
  return (
    <input
      id={id}
      aria-label={label}
      type="text"
      inputMode={field.type === "number" || field.type === "integer" ? "decimal" : "text"}
      class={field.type === "vector" ? "wide" : ""}
      value={draft.text}
      maxLength={MOST_TEXT}
      disabled={disabled}
      spellcheck={false}
      autocomplete="off"
      onFocus={draft.begin}
      onInput={(event) => draft.set(event.currentTarget.value)}
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

/** A text of a number to be read: whole ones with all digits, others with 7 and at least 3 behind the point. What has no
 * end stays a word. */
function shown(text: string): string {
  const number = Number(text);
  if (text === "" || !Number.isFinite(number)) return text;
  if (Number.isInteger(number)) return String(number);
  const before = Math.floor(Math.log10(Math.abs(number))) + 1;
  return String(Number(number.toPrecision(Math.min(17, Math.max(7, before + 3)))));
}

/** The number of a slider's place, without digits below its step. */
function placed(text: string, step: number): string {
  const decimals = Math.min(20, Math.max(0, 1 - Math.floor(Math.log10(step))));
  return String(Number(Number(text).toFixed(decimals)));
}

function NumberControl(props: Props) {
  const { field, id, value, disabled, set } = props;
  const draft = useDraft(value);
  const pace = usePace();
  if (!hasSlider(field)) return <TextControl {...props} value={shown(value)} />;
  const low = field.min as number;
  const high = field.max as number;
  const step = field.type === "integer" || field.whole ? 1 : (high - low) / 1000;
  const change = (text: string) => {
    draft.set(text);
    pace.later(() => set(text));
  };
  return (
    <>
      <input
        id={id}
        type="range"
        min={low}
        max={high}
        step={step}
        value={draft.text === "" ? low : draft.text}
        disabled={disabled}
        onPointerDown={draft.begin}
        onInput={(event) => change(placed(event.currentTarget.value, step))}
        onChange={draft.end}
        onPointerUp={draft.end}
        onPointerCancel={draft.end}
        onBlur={draft.end}
      />
      <TextControl {...props} id={`${id}-number`} value={shown(draft.text)} />
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
  const pace = usePace();
  const change = (text: string) => pace.later(() => set(text));
  return <input id={id} type="color" value={hexOf(value)} disabled={disabled} onInput={(event) => change(event.currentTarget.value)} />;
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

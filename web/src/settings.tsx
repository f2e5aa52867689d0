import { useMemo, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Control } from "./field";
import { Icon } from "./icons";
import type { Field } from "./protocol";
import { useStore } from "./store";

const readable = (name: string) => name.replaceAll("_", " ");

function Row({ field, connection }: { field: Field; connection: Connection }) {
  const value = useStore((state) => state.values[field.name]);
  const controls = useStore((state) => state.control.controls);
  const given = value?.value ?? "";
  const isAuto = given === "auto" || given === "follow";
  const shown = isAuto ? (value?.latched ?? "") : given;
  const label = readable(field.name.slice(field.name.indexOf(".") + 1));
  const id = `field-${field.name}`;
  const set = (text: string) => connection.set(field.name, text);
  return (
    <div class={isAuto ? "row automatic" : "row"} title={field.doc}>
      <label for={id}>
        {label}
        {field.unit && <span class="unit"> {field.unit}</span>}
      </label>
      <div class="control">
        <Control field={field} id={id} label={label} value={shown} disabled={!controls} set={set} />
        {field.auto ? (
          <button
            type="button"
            class="auto"
            aria-pressed={isAuto}
            aria-label={`${label}: automatic`}
            title={isAuto ? "Inferred; click to keep this value" : "Infer it again"}
            disabled={!controls || (isAuto && !shown)}
            onClick={() => set(isAuto ? shown : "auto")}
          >
            auto
          </button>
        ) : (
          <span class="auto-place" />
        )}
      </div>
    </div>
  );
}

function Group(props: { name: string; fields: Field[]; open: boolean; connection: Connection }) {
  const [open, setOpen] = useState(false);
  const isOpen = open || props.open;
  return (
    <section class="group">
      <h2>
        <button type="button" aria-expanded={isOpen} class={isOpen ? "fold open" : "fold"} onClick={() => setOpen(!open)}>
          <Icon name="chevron" />
          {readable(props.name)}
        </button>
      </h2>
      {isOpen && props.fields.map((field) => <Row key={field.name} field={field} connection={props.connection} />)}
    </section>
  );
}

/** Groups of the table in its order; a search opens those that have something. */
export function SettingsPanel({ connection }: { connection: Connection }) {
  const fields = useStore((state) => state.fields);
  const controls = useStore((state) => state.control.controls);
  const [search, setSearch] = useState("");
  const groups = useMemo(() => {
    const words = search.toLowerCase().split(/\s+/).filter(Boolean);
    const found = new Map<string, Field[]>();
    for (const field of fields) {
      const text = `${readable(field.name)} ${field.name} ${field.doc}`.toLowerCase();
      if (!words.every((word) => text.includes(word))) continue;
      const group = field.name.slice(0, field.name.indexOf("."));
      found.set(group, [...(found.get(group) ?? []), field]);
    }
    return [...found];
  }, [fields, search]);
  return (
    <div class="settings">
      <div class="search">
        <input
          type="search"
          placeholder="Search settings"
          aria-label="Search settings"
          value={search}
          onInput={(event) => setSearch(event.currentTarget.value)}
        />
        <button type="button" disabled={!controls} title="All settings and the camera as they were at first" onClick={() => connection.send({ kind: "act", what: "reset" })}>
          Reset
        </button>
      </div>
      {groups.map(([name, rows]) => (
        <Group key={name} name={name} fields={rows} open={search !== ""} connection={connection} />
      ))}
      {groups.length === 0 && <p class="hint">No setting is called so.</p>}
    </div>
  );
}

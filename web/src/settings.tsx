import { useMemo, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { FieldRow } from "./field_row";
import { Icon } from "./icons";
import type { Field } from "./protocol";
import { useStore } from "./store";

const readable = (name: string) => name.replaceAll("_", " ");

function Row({ field, connection }: { field: Field; connection: Connection }) {
  const value = useStore((state) => state.values[field.name]);
  const controls = useStore((state) => state.control.controls);
  const label = readable(field.name.slice(field.name.indexOf(".") + 1));
  const set = (text: string) => connection.set(field.name, text);
  return <FieldRow field={field} id={`field-${field.name}`} label={label} value={value?.value ?? ""} latched={value?.latched} disabled={!controls} set={set} />;
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

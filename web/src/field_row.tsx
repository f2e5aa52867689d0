// A setting, or what is like one: its name, its value, and whether it is automatic.
import { Control } from "./field";
import type { Field } from "./protocol";

export function FieldRow(props: {
  field: Field;
  id: string;
  label: string;
  value: string;
  latched?: string;
  disabled: boolean;
  set: (text: string) => void;
}) {
  const { field, id, label, value, disabled, set } = props;
  const isAuto = value === "auto" || value === "follow";
  const shown = isAuto ? (props.latched ?? "") : value;
  return (
    <div class={isAuto ? "row automatic" : "row"} title={field.doc}>
      <label for={id}>
        {label}
        {field.unit && <span class="unit"> {field.unit}</span>}
      </label>
      <div class="control">
        <Control field={field} id={id} label={label} value={shown} disabled={disabled} set={set} />
        {field.auto ? (
          <button
            type="button"
            class="auto"
            aria-pressed={isAuto}
            aria-label={`${label}: automatic`}
            title={isAuto ? "Inferred; click to keep this value" : "Infer it again"}
            disabled={disabled || (isAuto && !shown)}
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

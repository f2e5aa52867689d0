import { useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Icon } from "./icons";
import type { SceneNode } from "./protocol";
import { useStore } from "./store";

const count = new Intl.NumberFormat("en", { notation: "compact", maximumFractionDigits: 1 });
const exact = new Intl.NumberFormat("en");

const nameOf = (path: string) => path.slice(path.lastIndexOf("/") + 1) || "(unnamed)";
const OPEN_DEPTH = 2;

function sizeText(node: SceneNode): string {
  return node.faces ? count.format(node.faces) : node.vertices ? count.format(node.vertices) : "";
}

function Node({ node, depth, connection }: { node: SceneNode; depth: number; connection: Connection }) {
  const selected = useStore((state) => state.selected);
  const controls = useStore((state) => state.control.controls);
  const shared = useStore((state) => state.control.view === 0);
  const [open, setOpen] = useState(depth < OPEN_DEPTH);
  const name = nameOf(node.path);
  const isSelected = selected === node.path;
  return (
    <li>
      <div class={isSelected ? "node selected" : "node"}>
        {node.children ? (
          <button type="button" class={open ? "fold open" : "fold"} aria-label={`Parts of ${name}`} aria-expanded={open} onClick={() => setOpen(!open)}>
            <Icon name="chevron" />
          </button>
        ) : (
          <span class="fold" />
        )}
        <button
          type="button"
          class="name"
          aria-pressed={isSelected}
          title={`${node.path}: ${exact.format(node.vertices)} vertices, ${exact.format(node.faces)} faces`}
          disabled={!controls}
          onClick={() => connection.send({ kind: "select", object: isSelected ? "" : node.path })}
        >
          {name}
        </button>
        <span class="number">{sizeText(node)}</span>
        <button
          type="button"
          class="eye"
          aria-label={`Show ${name}`}
          aria-pressed={node.visible}
          title={shared ? undefined : "What all see is changed in the shared view"}
          disabled={!controls || !shared}
          onClick={() => connection.send({ kind: "show", object: node.path, visible: !node.visible })}
        >
          <Icon name={node.visible ? "eye" : "hidden"} />
        </button>
      </div>
      {open && node.children && (
        <ul>
          {node.children.map((child, index) => (
            <Node key={`${index} ${child.path}`} node={child} depth={depth + 1} connection={connection} />
          ))}
        </ul>
      )}
    </li>
  );
}

export function ScenePanel({ connection }: { connection: Connection }) {
  const nodes = useStore((state) => state.nodes);
  const shared = useStore((state) => state.control.view === 0);
  if (nodes.length === 0) return <p class="hint">Nothing is shown yet.</p>;
  return (
    <>
      <ul class="tree" aria-label="Objects">
        {nodes.map((node) => (
          <Node key={node.path} node={node} depth={0} connection={connection} />
        ))}
      </ul>
      {!shared && <p class="hint">Objects and lights are everybody's: they are changed in the shared view.</p>}
    </>
  );
}

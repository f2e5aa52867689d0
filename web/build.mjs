// Builds the page, the document that turns offline and the notebook widget into dist/ (or the folder named as argument), which is
// committed: the library embeds it.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { copyFile, mkdir, readFile, writeFile } from "node:fs/promises";

const out = process.argv[2] ?? "dist";
const common = {
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  jsx: "automatic",
  jsxImportSource: "preact",
  charset: "utf8",
};

async function buildPage() {
  await mkdir(out, { recursive: true });
  await build({ ...common, entryPoints: { app: "src/main.tsx" }, outdir: out });
  await copyFile("index.html", `${out}/index.html`);
  await copyFile("icon.svg", `${out}/icon.svg`);
}

const hashOf = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

/** One document with script and style in it, and places, {{title}} and so on, that the library fills. */
async function buildOrbit() {
  await mkdir(`${out}/offline`, { recursive: true });
  const made = await build({ ...common, format: "iife", entryPoints: ["src/orbit/main.ts"], outdir: out, write: false });
  const text = (ending) => made.outputFiles.find((file) => file.path.endsWith(ending)).text.trim();
  const script = text(".js");
  const style = text(".css");
  const policy = `default-src 'none'; img-src data:; script-src ${hashOf(script)}; style-src ${hashOf(style)}`;
  const parts = { policy, style, script };
  const template = await readFile("orbit.html", "utf8");
  await writeFile(`${out}/offline/orbit.html`, template.replace(/\{\{(policy|style|script)\}\}/g, (_, name) => parts[name]));
}

/** One module for notebooks, style and all. */
async function buildWidget() {
  const entryPoints = { widget: "src/widget/main.tsx" };
  await build({ ...common, entryPoints, outdir: `${out}/offline`, plugins: [cssText] });
}

/** Style sheets that are imported by name are texts, made small. */
const cssText = {
  name: "css-text",
  setup({ onLoad }) {
    onLoad({ filter: /\.css$/ }, async ({ path }) => {
      const made = await build({ entryPoints: [path], minify: true, write: false, charset: "utf8" });
      return { contents: made.outputFiles[0].text.trim(), loader: "text" };
    });
  },
};

await buildPage();
await buildOrbit();
await buildWidget();

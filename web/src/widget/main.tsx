// The notebook widget, as anywidget loads it: one connection for all places that show it in this page.
import { render } from "preact";
import { Connection } from "../connection";
import { StoreContext } from "../store";
import pageStyle from "../style.css";
import { CommWire, type Model } from "./comm";
import { Embedded } from "./embedded";
import style from "./widget.css";

/** Of JupyterLab, where it is; else of the system. */
function isLight(): boolean {
  const jupyter = document.body.dataset.jpThemeLight;
  return jupyter ? jupyter === "true" : !window.matchMedia("(prefers-color-scheme: dark)").matches;
}

function pictureOf(model: Model): string {
  const bytes = model.get("_picture") as DataView | undefined;
  if (!bytes?.byteLength) return "";
  const isPng = bytes.getUint8(0) === 0x89;
  return URL.createObjectURL(new Blob([bytes as DataView<ArrayBuffer>], { type: isPng ? "image/png" : "image/jpeg" }));
}

/** The notebook's own shortcuts, menus and styles stay out. */
function rootIn(element: HTMLElement, width: number, height: number): ShadowRoot {
  const host = document.createElement("div");
  host.dataset.lmSuppressShortcuts = "true";
  host.dataset.jupyterSuppressContextMenu = "true";
  host.dataset.theme = isLight() ? "light" : "dark";
  host.style.width = `${width}px`;
  host.style.aspectRatio = `${width} / ${height}`;
  for (const kind of ["keydown", "keyup", "keypress", "contextmenu"]) host.addEventListener(kind, (event) => event.stopPropagation());
  element.append(host);
  const root = host.attachShadow({ mode: "open" });
  const sheet = document.createElement("style");
  sheet.textContent = pageStyle + style;
  root.append(sheet);
  return root;
}

export default () => {
  let connection: Connection | null = null;
  const connect = (model: Model): Connection => {
    const rules = { needsToken: false, takesControl: true, takesVideo: false };
    connection ??= new Connection(new CommWire(model), { token: "", camera: "", settings: {} }, rules);
    return connection;
  };
  return {
    initialize() {
      return () => {
        connection?.end();
        connection = null;
      };
    },
    render({ model, el }: { model: Model; el: HTMLElement }) {
      const root = rootIn(el, Number(model.get("_width")), Number(model.get("_height")));
      const place = document.createElement("div");
      root.append(place);
      const picture = pictureOf(model);
      const shared = connect(model);
      render(
        <StoreContext.Provider value={shared.store}>
          <Embedded connection={shared} picture={picture} label={String(model.get("_label"))} />
        </StoreContext.Provider>,
        place,
      );
      return () => {
        render(null, place);
        URL.revokeObjectURL(picture);
      };
    },
  };
};

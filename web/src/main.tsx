import { render } from "preact";
import { App } from "./app";
import { Connection } from "./connection";
import "./style.css";
import { startTheme } from "./theme";

startTheme();
const connection = new Connection();
render(<App connection={connection} />, document.getElementById("app") as HTMLElement);

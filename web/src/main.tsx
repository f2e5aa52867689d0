import { render } from "preact";
import { App } from "./app";
import { Connection } from "./connection";
import { keepToken, takeLink } from "./link";
import { StoreContext } from "./store";
import "./style.css";
import { startTheme } from "./theme";
import { SocketWire } from "./wire";

startTheme();
const connection = new Connection(new SocketWire(), takeLink(), { needsToken: true, takesControl: false, takesVideo: true, keepToken });
const page = (
  <StoreContext.Provider value={connection.store}>
    <App connection={connection} />
  </StoreContext.Provider>
);
render(page, document.getElementById("app") as HTMLElement);

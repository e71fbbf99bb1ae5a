import { render } from "preact";
import { App } from "./app";
import { startLive } from "./draft/live";
import { listenForPaste } from "./panel/open";

startLive();
listenForPaste();
render(<App />, document.getElementById("page")!);

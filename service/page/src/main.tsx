import { render } from "preact";
import { App } from "./app";
import { startLive } from "./draft/live";
import { startProposing } from "./draft/proposing";
import { listenForPaste } from "./panel/open";

startLive();
startProposing();
listenForPaste();
render(<App />, document.getElementById("page")!);

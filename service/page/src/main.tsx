import { render } from "preact";
import { App } from "./app";
import { startLive } from "./draft/live";
import { startProposing } from "./draft/proposing";
import { startMeasuring } from "./measure/places";
import { listenForPaste } from "./panel/open";

startLive();
startProposing();
startMeasuring();
listenForPaste();
render(<App />, document.getElementById("page")!);

import { effect } from "@preact/signals";
import { render } from "preact";
import { startWatchingConnection } from "./api/connection";
import { App } from "./app";
import { startLive } from "./draft/live";
import { listenForPaste } from "./draft/open";
import { startFollowing } from "./draft/proposing";
import { startMasks } from "./mask/edits";
import { isOnAccuracy, isTrying, openFit } from "./route";
import { startFilling } from "./stage/full";
import { announce } from "./ui/announce";

startWatchingConnection();
startFollowing();
startLive();
startMasks();
startFilling();
listenForPaste();
// What was announced on one screen is not said on the next.
effect(() => {
  void [openFit.value, isOnAccuracy.value, isTrying.value];
  announce("");
});
render(<App />, document.getElementById("page")!);

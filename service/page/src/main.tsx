import { render } from "preact";
import { startWatchingConnection } from "./api/connection";
import { App } from "./app";
import { startLasting } from "./draft/lasting";
import { startLive } from "./draft/live";
import { startProposing } from "./draft/proposing";
import { startCheckingClothes } from "./mask/clothes";
import { startMasks } from "./mask/edits";
import { startProposingMasks } from "./mask/proposed";
import { startMeasuring } from "./measure/places";
import { startSpeaking } from "./messages/language";
import { listenForPaste } from "./panel/open";
import { isEmbedded } from "./route";
import { startFilling } from "./stage/full";
import { startForgetting } from "./ui/forgetting";

await startSpeaking();
startMeasuring();
startForgetting();
const root = document.getElementById("page")!;
if (isEmbedded) {
  const { startEmbedding } = await import("./embed/start");
  startEmbedding(root);
} else {
  startWatchingConnection();
  startLive();
  startProposing();
  startProposingMasks();
  startMasks();
  startFilling();
  startCheckingClothes();
  void startLasting();
  listenForPaste();
  render(<App />, root);
}

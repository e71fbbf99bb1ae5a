// What was announced on one screen is not said on the next.
import { effect } from "@preact/signals";
import { isMeasuring, isOnAccuracy, openFit, openScan } from "../route";
import { announce } from "./announce";

export function startForgetting(): void {
  effect(() => {
    void [openFit.value, openScan.value, isMeasuring.value, isOnAccuracy.value];
    announce("");
  });
}

// What was announced on one screen is not said on the next.
import { effect } from "@preact/signals";
import { isMeasuring, isOnAccuracy, openFit } from "../route";
import { announce } from "./announce";

export function startForgetting(): void {
  effect(() => {
    void [openFit.value, isMeasuring.value, isOnAccuracy.value];
    announce("");
  });
}

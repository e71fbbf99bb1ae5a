// Says that this service is a sandbox, if it is one: nobody is to take its results for measurements.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { getIndex } from "../api/calls";
import { messages } from "../messages/language";

const isSandbox = signal(false);

export function SandboxNote() {
  useEffect(() => {
    getIndex().then(
      (index) => (isSandbox.value = index.sandbox === true),
      () => undefined,
    );
  }, []);
  return isSandbox.value ? (
    <p class="sandbox-note" role="note">
      {messages.value.frame.sandbox}
    </p>
  ) : null;
}

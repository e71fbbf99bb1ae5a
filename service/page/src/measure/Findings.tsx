// What is wrong with a picture, in words: why, and what to do.
import type { Finding } from "../api/types";

export function Findings({ findings }: { findings: readonly Finding[] }) {
  return (
    <ul class="findings">
      {findings.map(({ code, severity, reason, remedy }) => (
        <li key={code} class={`note ${severity === "blocks" ? "is-problem" : ""}`} data-code={code}>
          <strong>{severity === "blocks" ? "Take it again" : "Could be better"}</strong>
          <p>
            {reason} {remedy}
          </p>
        </li>
      ))}
    </ul>
  );
}

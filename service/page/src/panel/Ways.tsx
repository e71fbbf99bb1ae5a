// What a mouse, fingers and keys do on the picture.
import { messages } from "../messages";

export function Ways() {
  const { ways } = messages.panel;
  return (
    <details class="fold">
      <summary>{ways.title}</summary>
      <dl class="ways">
        {ways.list.map(({ way, does }) => (
          <>
            <dt>{way}</dt>
            <dd>{does}</dd>
          </>
        ))}
      </dl>
    </details>
  );
}

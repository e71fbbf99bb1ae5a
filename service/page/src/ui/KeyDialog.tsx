// Asks for an API key when the service wants one.
import { useEffect, useRef } from "preact/hooks";
import { keyQuestion, useKey } from "../api/key";
import { messages } from "../messages";

export function KeyDialog() {
  const dialog = useRef<HTMLDialogElement>(null);
  const field = useRef<HTMLInputElement>(null);
  const reason = keyQuestion.value;
  const { key } = messages.frame;
  useEffect(() => {
    if (reason !== null && !dialog.current!.open) dialog.current!.showModal();
    if (reason === null) dialog.current!.close();
  }, [reason]);
  return (
    <dialog ref={dialog} class="dialog" aria-labelledby="key-title" onCancel={(event) => event.preventDefault()}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          const typed = field.current!.value.trim();
          field.current!.value = "";
          if (typed !== "") useKey(typed);
        }}
      >
        <h2 id="key-title">{key.title}</h2>
        <p>
          {reason} {key.origin} <code>maquette keys create</code>.
        </p>
        <label class="field">
          <span>{key.label}</span>
          <input ref={field} type="password" autocomplete="off" spellcheck={false} required />
        </label>
        <p class="fine">{key.kept}</p>
        <button class="button is-primary" type="submit">
          {key.use}
        </button>
      </form>
    </dialog>
  );
}

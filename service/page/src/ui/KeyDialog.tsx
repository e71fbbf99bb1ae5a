// Asks for an API key when the service wants one.
import { useEffect, useRef } from "preact/hooks";
import { keyQuestion, useKey } from "../api/key";

export function KeyDialog() {
  const dialog = useRef<HTMLDialogElement>(null);
  const field = useRef<HTMLInputElement>(null);
  const reason = keyQuestion.value;
  useEffect(() => {
    if (reason !== null && !dialog.current!.open) dialog.current!.showModal();
    if (reason === null) dialog.current!.close();
  }, [reason]);
  return (
    <dialog ref={dialog} class="dialog" aria-labelledby="key-title" onCancel={(event) => event.preventDefault()}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          const key = field.current!.value.trim();
          field.current!.value = "";
          if (key !== "") useKey(key);
        }}
      >
        <h2 id="key-title">This service asks for a key</h2>
        <p>{reason} Whoever runs it makes keys with <code>maquette keys create</code>.</p>
        <label class="field">
          <span>API key</span>
          <input ref={field} type="password" autocomplete="off" spellcheck={false} required />
        </label>
        <p class="fine">It is kept in this tab until you close it.</p>
        <button class="button is-primary" type="submit">
          Use this key
        </button>
      </form>
    </dialog>
  );
}

// Other poses.
import type { NamedPose } from "../../api/types";
import { messages } from "../../messages";
import type { Kind, OptionProps } from "./kind";

const POSES = Object.keys(messages.products.pose.names) as NamedPose[];

interface PoseWishes {
  readonly pose: NamedPose;
}

export const FIRST_POSE: PoseWishes = { pose: "standing" };

export const pose: Kind<PoseWishes> = {
  request: ({ pose }) => ({ kind: "pose", pose }),
  Options: PoseChoice,
  body: { file: "body_reposed.glb", label: messages.products.pose.turned },
};

function PoseChoice({ wishes: { pose }, onWish }: OptionProps<PoseWishes>) {
  const words = messages.products.pose;
  return (
    <div class="field">
      <label for="pose">{words.label}</label>
      <select id="pose" value={pose} onChange={(event) => onWish({ pose: event.currentTarget.value as NamedPose })}>
        {POSES.map((each) => (
          <option key={each} value={each}>
            {words.names[each]}
          </option>
        ))}
      </select>
    </div>
  );
}

// Textures of the picture.
import type { TextureColours, TextureSize } from "../../api/types";
import { LIMITS } from "../../api/limits";
import { messages } from "../../messages";
import { Choice } from "../../ui/Choice";
import type { Kind, OptionProps } from "./kind";

interface TextureWishes {
  readonly colours: TextureColours;
  readonly size: TextureSize;
}

const words = messages.products.texture;

export const FIRST_TEXTURE: TextureWishes = { colours: "picture", size: 1024 };

export const texture: Kind<TextureWishes> = {
  request: ({ colours, size }) => ({ kind: "texture", colours, size }),
  Options: TextureChoice,
  picture: "texture.png",
  body: { file: "body_textured.glb", label: words.turned },
};

function TextureChoice({ hasLight, wishes, onWish }: OptionProps<TextureWishes>) {
  const photographed = { value: "picture", ...words.photographed } as const;
  const unlit = { value: "albedo", ...words.unlit } as const;
  return (
    <>
      <Choice<TextureColours>
        name="colours"
        legend={words.colours}
        options={hasLight ? [photographed, unlit] : [photographed]}
        value={wishes.colours}
        onChange={(colours) => onWish({ colours })}
      />
      {!hasLight && <p class="fine">{words.onlyShading}</p>}
      <div class="field">
        <label for="texture-size">{words.size}</label>
        <select id="texture-size" value={wishes.size} onChange={(event) => onWish({ size: Number(event.currentTarget.value) as TextureSize })}>
          {LIMITS.textureSizes.map((size) => (
            <option key={size} value={size}>
              {size} × {size}
            </option>
          ))}
        </select>
      </div>
    </>
  );
}

import{c as j}from"/page/chunk.UDWSOI27.js";import{n as E}from"/page/chunk.BUZV76AB.js";import"/page/chunk.DBJBPITO.js";import"/page/chunk.DHSW2F7S.js";import{a as I,b as O,c as q}from"/page/chunk.I4BVN3KQ.js";import{a as W}from"/page/chunk.HMJ2MS2C.js";import{A as x,I as _,c as A,d as b,e as F,f as k,h as g,j as R,l as u,m as C,n as G,o as z,q as f,r as M,u as B,v,w as N,x as V,y as U,z as D}from"/page/chunk.64GWOZLD.js";import"/page/chunk.F5XGFZ2T.js";var y=3.2,c=96,J=.08,S=2,Z=`
  out vec2 vPlace;
  void main() {
    vPlace = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,$=`
  precision highp float;
  in vec2 vPlace;
  uniform sampler2D near;
  uniform float side;
  out vec4 colour;
  void main() {
    vec2 metres = (vPlace - 0.5) * side;
    float fade = 1.0 - smoothstep(0.25, 1.0, length(metres) / (0.5 * side));
    vec2 cell = abs(fract(metres / 0.5 + 0.5) - 0.5) * 0.5;
    vec2 width = max(fwidth(metres), vec2(0.004));
    vec2 line = 1.0 - smoothstep(vec2(0.0), width, cell);
    float dark = texture(near, vec2(vPlace.x, 1.0 - vPlace.y)).r;
    float alpha = max(max(line.x, line.y) * 0.3 * fade, 0.1 * fade);
    colour = vec4(mix(vec3(0.5), vec3(0.0), dark), max(alpha, 0.5 * dark));
  }
`,w=class{mesh;near;constructor(){this.near=new N(new Uint8Array(c*c),c,c,F),this.near.minFilter=this.near.magFilter=b;let e=new x({glslVersion:g,vertexShader:Z,fragmentShader:$,transparent:!0,depthWrite:!1,uniforms:{near:{value:this.near},side:{value:y}}});this.mesh=new v(new U(y,y).rotateX(-Math.PI/2),e)}layUnder(e,t){let i=e.reduce((l,{y:s})=>Math.min(l,s),1/0);this.mesh.position.set(t.x,i,t.z);let r=new Float32Array(c*c);for(let{x:l,y:s,z:h}of e){let m=Math.floor(((l-t.x)/y+.5)*c),d=Math.floor(((h-t.z)/y+.5)*c);if(m<0||d<0||m>=c||d>=c)continue;let p=d*c+m;r[p]=Math.max(r[p],Math.exp((i-s)/J))}let a=this.near.image.data;H(H(r)).forEach((l,s)=>a[s]=Math.min(255,Math.round(255*l))),this.near.needsUpdate=!0}dispose(){this.near.dispose(),this.mesh.geometry.dispose(),this.mesh.material.dispose()}};function H(o){return o.map((e,t)=>{let[i,r]=[Math.floor(t/c),t%c],[a,n]=[0,0];for(let l=Math.max(0,i-S);l<=Math.min(c-1,i+S);l++)for(let s=Math.max(0,r-S);s<=Math.min(c-1,r+S);s++)a+=o[l*c+s],n+=1;return a/n})}var X=["lit","clay","albedo","specularity","shading","residual","change"],ee=`
  in vec3 tint;
  in float albedo;
  in float specularity;
  in vec3 posed;
  in vec3 posedNormal;
  in float lit;
  in float posedLit;
  in float shift;
  in vec2 mark;
  out vec2 vMark;
  out float vLit;
  out float vPosedLit;
  out vec3 vPosition;
  out vec3 vNormal;
  out vec3 vTint;
  out vec2 vReflectance;
  out vec3 vPosed;
  out vec3 vPosedNormal;
  out float vShift;
  out vec3 vSeenNormal;
  void main() {
    vSeenNormal = normalMatrix * normal;
    vPosition = position;
    vNormal = normal;
    vTint = tint;
    vReflectance = vec2(albedo, specularity);
    vPosed = posed;
    vPosedNormal = posedNormal;
    vLit = lit;
    vPosedLit = posedLit;
    vShift = shift;
    vMark = mark;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,te=`
  precision highp float;
  in vec3 vPosition;
  in vec3 vNormal;
  in vec3 vTint;
  in vec2 vReflectance;
  in vec3 vPosed;
  in vec3 vPosedNormal;
  in float vShift;
  in float vLit;
  in float vPosedLit;
  in vec3 vSeenNormal;
  in vec2 vMark;
  uniform bool hasSurroundings;
  uniform float surroundings[9];
  uniform int surface;
  uniform bool isPoint;
  uniform vec3 lightVector;
  uniform vec3 posedLight;
  uniform float lightDistance;
  uniform float ambient;
  uniform float exponent;
  uniform vec3 eye;
  uniform vec3 clay;
  uniform sampler2D picture;
  uniform vec2 pictureSize;
  uniform vec3 intrinsics;
  out vec4 colour;

  vec2 eq1(vec3 position, vec3 normal, vec3 toEye, vec3 light) {
    vec3 path = isPoint ? light - position : light;
    float intensity = isPoint ? lightDistance * lightDistance / dot(path, path) : 1.0;
    vec3 toLight = normalize(path);
    float facing = dot(toLight, normal);
    if (facing <= 0.0) return vec2(0.0);
    float mirror = max(dot(normalize(toLight + toEye), normal), 0.0);
    return intensity * vec2(facing, pow(mirror, exponent));
  }

  float fromSurroundings(vec3 n) {
    float sum = 0.2820947918 * surroundings[0]
      + 0.4886025119 * dot(vec3(surroundings[3], surroundings[1], surroundings[2]), n)
      + 1.0925484306 * (surroundings[4] * n.x * n.y + surroundings[5] * n.y * n.z + surroundings[7] * n.x * n.z)
      + 0.3153915653 * surroundings[6] * (3.0 * n.z * n.z - 1.0)
      + 0.5462742153 * surroundings[8] * (n.x * n.x - n.y * n.y);
    return max(sum, 0.0);
  }

  // What a surface of this albedo and specularity shows, given the factors of Eq. 1.
  vec3 shaded(vec3 albedo, float specularity, vec3 normal, vec2 terms, float isLit) {
    if (!hasSurroundings) return ambient + albedo * terms.x + specularity * terms.y;
    return albedo * (fromSurroundings(normal) + isLit * terms.x) + specularity * isLit * terms.y;
  }

  vec3 encoded(vec3 linear) {
    vec3 clipped = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(clipped, vec3(1.0 / 2.4)) - 0.055, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
  }

  vec3 decoded(vec3 display) {
    return mix(pow((display + 0.055) / 1.055, vec3(2.4)), display / 12.92, lessThanEqual(display, vec3(0.04045)));
  }

  // The lamp walks along with the eye: no side of a form lies in the dark.
  vec3 claySurface(vec3 seen, vec3 normal, vec3 toEye) {
    float key = max(dot(seen, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float sky = 0.5 + 0.5 * seen.y;
    float rim = pow(1.0 - max(dot(normal, toEye), 0.0), 3.0);
    return clay * (0.16 + 0.22 * sky + 0.66 * key) + 0.05 * rim;
  }

  // Of the picture and of Eq. 1 at the same place of the surface, whatever it is seen from.
  vec3 residualSurface() {
    vec3 normal = normalize(vPosedNormal);
    vec3 toEye = normalize(-vPosed);
    if (dot(normal, toEye) < 0.2) return vec3(0.35);
    vec2 pixel = intrinsics.x * vec2(vPosed.x, -vPosed.y) / -vPosed.z + intrinsics.yz;
    vec2 place = pixel / pictureSize;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) return vec3(0.35);
    float seen = dot(decoded(texture(picture, vec2(place.x, 1.0 - place.y)).rgb), vec3(0.2126, 0.7152, 0.0722));
    vec2 terms = eq1(vPosed, normal, toEye, posedLight);
    float difference = seen - shaded(vec3(vReflectance.x), vReflectance.y, normal, terms, vPosedLit).x;
    float strength = clamp(abs(difference) / 0.12, 0.0, 1.0);
    vec3 hue = difference > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    return mix(vec3(0.78), hue, strength);
  }

  // How far shading moved the surface, full colour at 1 cm, over a little clay for its form.
  vec3 changeSurface(vec3 normal, vec3 toEye) {
    float strength = clamp(abs(vShift) / 0.01, 0.0, 1.0);
    vec3 hue = vShift > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    float form = 0.45 + 0.55 * max(dot(normal, toEye), 0.0);
    return form * mix(vec3(0.78), hue, strength);
  }

  void main() {
    vec3 normal = normalize(vNormal);
    vec3 toEye = normalize(eye - vPosition);
    vec3 seen = normalize(vSeenNormal);
    if (!gl_FrontFacing) {
      normal = -normal;
      seen = -seen;
    }
    vec2 terms = eq1(vPosition, normal, toEye, lightVector);
    vec3 linear;
    if (surface == 1) linear = claySurface(seen, normal, toEye);
    else if (surface == 2) linear = vTint;
    else if (surface == 3) linear = vec3(vReflectance.y);
    else if (surface == 4) linear = shaded(vec3(0.5), 0.2, normal, terms, vLit);
    else if (surface == 5) linear = residualSurface();
    else if (surface == 6) linear = changeSurface(normal, toEye);
    else linear = shaded(vTint, vReflectance.y, normal, terms, vLit);
    // Limbs that were turned, and the one pointed at.
    linear = mix(linear, vec3(0.08, 0.3, 0.75) * (0.4 + 0.6 * max(seen.z, 0.0)), 0.6 * clamp(vMark.y, 0.0, 1.0));
    linear = mix(linear, vec3(1.0, 0.38, 0.02) * (0.5 + 0.5 * max(seen.z, 0.0)), 0.55 * vMark.x);
    colour = vec4(encoded(linear), 1.0);
  }
`,re=new u(.74,.66,.58);function K(o,e){let{light:t}=o;return new x({glslVersion:g,vertexShader:ee,fragmentShader:te,side:A,uniforms:{surface:{value:0},isPoint:{value:t?.kind==="point"},lightVector:{value:new u(...t?.vector??[0,0,1])},posedLight:{value:new u(...t?.vector??[0,0,1])},lightDistance:{value:t?.distance??1},hasSurroundings:{value:t?.surroundings!=null},surroundings:{value:t?.surroundings??new Array(9).fill(0)},ambient:{value:t?.ambient??.1},exponent:{value:t?.exponent??20},eye:{value:new u},clay:{value:re},picture:{value:e},pictureSize:{value:ie(o.camera)},intrinsics:{value:oe(o.camera)}}})}function ie(o){return new R(o?.width??1,o?.height??1)}function oe(o){return new u(o?.fx??1,o?.cx??0,o?.cy??0)}function Y(o,e){let[t,i,r]=[o.positions,e.positions,e.normals];return Float32Array.from({length:i.length/3},(a,n)=>{let l=0;for(let s=3*n;s<3*n+3;s++)l+=(i[s]-t[s])*r[s];return l})}function L(o,e,t){let i=o.positions.length/3,r=(m,d)=>new Float32Array(d*i).fill(m),a=new M,n=(m,d,p)=>a.setAttribute(m,new f(d,p));n("position",o.positions,3),n("normal",o.normals,3),n("posed",e.positions,3),n("posedNormal",e.normals,3),n("tint",ae(o.colours,e.light?.colourScale??1)??r(.6,3),3),n("albedo",o.albedo??r(.6,1),1),n("specularity",o.specularity??r(0,1),1),n("lit",o.lit??r(1,1),1),n("posedLit",e.lit??r(1,1),1),n("shift",r(0,1),1),n("mark",r(0,2),2),a.setIndex(new f(o.triangles,1)),a.computeBoundingBox();let l=a.boundingBox,s=l.getCenter(new u),h=K(e,t);return o!==e&&e.light&&ne(h,e,s),{mesh:new v(a,h),centre:s,size:l.getSize(new u)}}function ne(o,e,t){if(e.light.kind!=="point")return;let i=new M;i.setAttribute("position",new f(e.positions,3)),i.computeBoundingBox();let r=i.boundingBox.getCenter(new u);o.uniforms.lightVector.value.sub(r).add(t)}function ae(o,e){return o&&o.map(t=>t*e)}var se=.0028,le=96,ce=6,ue={colour:10634271,opacity:.8},me={colour:16753951,opacity:1},de=.22,P=class{constructor(e){this.lines=e;for(let[t,i]of Object.entries(e)){let r=new v(he(i),new B({transparent:!0}));this.tapes.set(t,r),this.group.add(r)}this.mark(null)}lines;group=new G;tapes=new Map;mark(e){let t=e!==null&&this.tapes.has(e);for(let[i,r]of this.tapes){let a=i===e;r.visible=a||E(i);let n=a?me:ue;r.material.color.setHex(n.colour),r.material.opacity=t&&!a?de:n.opacity,r.material.depthTest=!a,r.renderOrder=a?2:1}}endsOn(e,t,i){return[...this.tapes].filter(([,r])=>r.visible).map(([r])=>{let a=this.lines[r].map(([h,m,d])=>{let p=new u(h,m,d).project(e);return[(.5+.5*p.x)*t,(.5-.5*p.y)*i]}),[n,...l]=a,s=h=>l.reduce((m,d)=>h*d[0]>h*m[0]?d:m,n);return{name:r,left:s(-1),right:s(1)}})}dispose(){for(let e of this.tapes.values())e.geometry.dispose(),e.material.dispose()}};function he(o){let e=o.map(([i,r,a])=>new u(i,r,a)),t=e.length>3&&e[0].equals(e.at(-1));return t&&e.pop(),new D(new V(e,t),le,se,ce,t)}var pe=.35,Q=class{constructor(e,t,i,r,a){this.body=t;this.upright=i;this.renderer=new _({canvas:e,alpha:!0,antialias:!0}),this.renderer.setPixelRatio(Math.min(window.devicePixelRatio||1,2)),this.renderer.setClearColor(0,0),this.texture=new C(r),this.texture.colorSpace=k,this.texture.generateMipmaps=!1,this.texture.minFilter=b,this.texture.needsUpdate=!0,this.parts=this.added({posed:t,canonical:i}),this.tapes=new P(a),this.scene.add(this.tapes.group,this.floor.mesh),this.facing=W(t,i),this.table=new q(e,()=>this.draw()),this.place("picture")}body;upright;renderer;scene=new z;table;parts;outlined=null;cues="SES";kind="lit";marked=null;texture;tapes;floor=new w;facing;onTapes=null;placement="picture";limbTools=null;flips=j;pointedAt=null;scheduled=0;isSized=!1;place(e){this.placement=e,this.reveal(),this.table.enabled=e!=="picture",this.renderer.domElement.style.touchAction=e==="picture"?"auto":"pan-y",e!=="picture"&&(this.setUpright(),this.table.lookAt(this.shown(),e==="canonical"?pe:0),this.layFloor()),this.draw()}lookFrom(e){if(this.placement==="picture")return;let t=this.placement==="canonical"?0:this.facing;this.table.lookAt(this.shown(),t+O[e]),this.draw()}followTapes(e){this.onTapes=e,this.draw()}surface(e){this.kind=e;for(let t of this.all())t.mesh.material.uniforms.surface.value=X.indexOf(e);this.draw()}compareWith(e){if(!(!e||this.outlined)){if(this.outlined=this.added(e),this.upright&&e.canonical){let t=new f(Y(e.canonical,this.upright),1);for(let i of T(this.parts))i.mesh.geometry.setAttribute("shift",t)}this.reveal(),this.draw()}}show(e){this.cues=e,this.reveal(),this.draw()}mark(e){this.marked=e,this.tapes.mark(e),this.draw()}useLimbs(e){this.limbTools=e,this.turnLimbs(this.flips)}turnLimbs(e){this.flips=e,this.limbTools?.reshape(this.parts.posed.mesh,this.limbTools.bent(this.body,e)??this.body),this.placement==="turned"&&this.layFloor(),this.markLimb(this.pointedAt)}markLimb(e){this.pointedAt=e,this.limbTools?.markLimbs(this.parts.posed.mesh,e,this.flips),this.draw()}limbAt(e,t){let{mesh:i}=this.parts.posed;if(!this.limbTools||this.shown().mesh!==i)return null;let{left:r,top:a,width:n,height:l}=this.renderer.domElement.getBoundingClientRect();return this.limbTools.limbUnder(i,this.table.camera,2*(e-r)/n-1,1-2*(t-a)/l)}resize(e,t){e===0||t===0||(this.renderer.setSize(e,t,!1),this.table.aspect=e/t,this.isSized=!0,this.render())}turnBy(e){return this.placement!=="picture"&&this.table.turnBy(e)}dispose(){cancelAnimationFrame(this.scheduled),this.table.dispose(),this.texture.dispose(),this.tapes.dispose(),this.floor.dispose();for(let e of this.all())e.mesh.geometry.dispose(),e.mesh.material.dispose();this.renderer.dispose()}shown(){let{posed:e,canonical:t}=this.cues==="SE"&&this.outlined||this.parts;return this.placement==="canonical"&&t?t:e}added({posed:e,canonical:t}){let i={posed:L(e,e,this.texture),canonical:t&&L(t,e,this.texture)};for(let r of T(i))this.scene.add(r.mesh);return i}all(){return[...T(this.parts),...this.outlined?T(this.outlined):[]]}reveal(){let e=this.shown();for(let t of this.all())t.mesh.visible=t===e;this.tapes.group.visible=e===this.parts.canonical,this.floor.mesh.visible=this.placement==="canonical"||this.placement==="turned"&&this.body.upright!==null}layFloor(){let{mesh:e,centre:t}=this.shown(),i=e.geometry.getAttribute("position"),r=Array.from({length:i.count},(a,n)=>new u().fromBufferAttribute(i,n).applyMatrix4(e.matrixWorld));this.floor.layUnder(r,t)}draw(){cancelAnimationFrame(this.scheduled),this.scheduled=requestAnimationFrame(()=>this.render())}render(){if(!this.isSized)return;let{mesh:e}=this.shown(),{camera:t}=this.table;this.placement==="picture"?this.useFittedCamera():this.useFreeCamera(),this.setUpright(),e.material.uniforms.eye.value.copy(e.worldToLocal(t.position.clone())),this.renderer.render(this.scene,t);let{clientWidth:i,clientHeight:r}=this.renderer.domElement;this.onTapes?.(this.tapes.group.visible?this.tapes.endsOn(t,i,r):[]);let a=this.cues==="SE"&&this.outlined?"SE":"SES",{dataset:n}=this.renderer.domElement;n.shows=[this.placement,this.kind,a,this.marked??"none"].join(" "),this.limbTools&&(n.limbs=[this.pointedAt??"none",...Object.entries(this.flips).flat()].join(" "))}setUpright(){for(let{posed:e}of[this.parts,this.outlined??this.parts]){let{mesh:t,centre:i}=e;t.quaternion.identity(),this.placement==="turned"&&this.body.upright&&t.quaternion.fromArray(this.body.upright),t.position.copy(i).sub(i.clone().applyQuaternion(t.quaternion)),t.updateMatrixWorld()}}useFreeCamera(){this.table.camera.fov=I,this.table.camera.updateProjectionMatrix()}useFittedCamera(){let{camera:e}=this.body;if(!e)return;let t=.02,i=100,r=this.table.camera;r.position.set(0,0,0),r.quaternion.identity(),r.updateMatrixWorld(),r.projectionMatrix.makePerspective(-e.cx/e.fx*t,(e.width-e.cx)/e.fx*t,e.cy/e.fx*t,-(e.height-e.cy)/e.fx*t,t,i),r.projectionMatrixInverse.copy(r.projectionMatrix).invert()}};function T({posed:o,canonical:e}){return e?[o,e]:[o]}export{Q as BodyScene};

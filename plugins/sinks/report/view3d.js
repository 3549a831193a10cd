// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// The report's 3D view: points of one scene at a time, its boards, and the sensors, in the LiDAR frame. It draws only when
// something changes, and can be used by keys alone.
(function () {
  "use strict";
  const place = document.getElementById("view3d");
  const result = JSON.parse(document.getElementById("data").textContent);
  const view = JSON.parse(document.getElementById("view-data").textContent);

  function has_webgl() {
    try {
      const canvas = document.createElement("canvas");
      return Boolean(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"));
    } catch (error) {
      return false;
    }
  }
  if (typeof THREE === "undefined" || !has_webgl() || view.scenes.length === 0) {
    if (view.scenes.length === 0) document.getElementById("view-message").textContent = "There are no points to show.";
    place.dataset.state = "absent";
    return;
  }

  // --- the page's part

  function make(tag, attributes, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
  }
  const frame = make("div", { class: "view", tabindex: "0", role: "application", "aria-label": "3D view of the points",
    "aria-describedby": "view-keys" });
  const controls = make("div", { class: "controls screen" });
  const keys = make("p", { class: "soft screen", id: "view-keys" },
    "Drag to turn, with Shift to move; the wheel zooms once the view was clicked. Keys: arrows turn, Shift and arrows move, " +
    "+ and \u2212 zoom, O overview, C camera, L LiDAR, A above, N and P next and previous scene.");
  place.replaceChildren(controls, frame, keys);

  // --- the scene

  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.setClearColor(0x14171a);
  frame.append(renderer.domElement);
  const world = new THREE.Scene();
  const eye = new THREE.PerspectiveCamera(55, 1, 0.02, 2000);

  function vector(list) { return new THREE.Vector3(list[0], list[1], list[2]); }
  function line_segments(points, colour) {
    return new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(points),
      new THREE.LineBasicMaterial({ color: colour }));
  }

  // Each camera's pose as it stands in result.json: columns x, y, z and origin of the camera in the LiDAR frame.
  const cameras = result.extrinsics.map((one, index) => {
    const T = one.T_lidar_camera;
    const pose = new THREE.Matrix4().set(...T[0], ...T[1], ...T[2], ...T[3]);
    const column = (c) => new THREE.Vector3(T[0][c], T[1][c], T[2][c]);
    return { name: one.camera, pose, x: column(0), y: column(1), z: column(2), origin: column(3),
      rays: view.photo_rays[index] || [] };
  });

  // Up is the LiDAR's axis that lies nearest to the camera's up.
  function up_axis() {
    const wanted = cameras.length > 0 ? cameras[0].y.clone().negate() : new THREE.Vector3(0, 0, 1);
    const axes = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]].map(vector);
    return axes.reduce((best, axis) => (axis.dot(wanted) > best.dot(wanted) ? axis : best));
  }
  const up = up_axis();
  function ahead() {
    const forward = cameras.length > 0 ? cameras[0].z.clone() : new THREE.Vector3(1, 0, 0);
    forward.addScaledVector(up, -forward.dot(up));
    return forward.length() > 0.1 ? forward.normalize() : new THREE.Vector3(up.y, up.z, up.x);
  }
  const forward = ahead();
  const right = new THREE.Vector3().crossVectors(forward, up);

  // --- sensors

  const labels = [];
  const sensors = new THREE.Group();
  function add_label(text, at) {
    const element = make("span", { class: labels.length % 2 === 0 ? "name" : "name above" }, text);
    frame.append(element);
    labels.push({ element, at });
  }
  sensors.add(new THREE.AxesHelper(0.25));
  add_label(cameras.length > 0 ? result.extrinsics[0].lidar || "LiDAR" : "LiDAR", new THREE.Vector3());
  for (const camera of cameras) {
    const axes = new THREE.AxesHelper(0.2);
    axes.applyMatrix(camera.pose);
    sensors.add(axes);
    add_label(camera.name, camera.origin);
    const corners = camera.rays.map((ray) => vector(ray).multiplyScalar(0.35).applyMatrix4(camera.pose));
    const lines = [];
    corners.forEach((corner, i) => lines.push(camera.origin, corner, corner, corners[(i + 1) % corners.length]));
    sensors.add(line_segments(lines, 0x9fb4c4));
  }
  world.add(sensors);

  // --- points and boards of one scene

  function bytes(text) {
    const raw = atob(text);
    const list = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) list[i] = raw.charCodeAt(i);
    return list;
  }
  function cloud_of(scene) {
    const packed = new DataView(bytes(scene.points).buffer);
    const places = new Float32Array(3 * scene.shown);
    for (let i = 0; i < places.length; ++i)
      places[i] = scene.low[i % 3] + scene.step[i % 3] * packed.getUint16(2 * i, true);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(bytes(scene.colours), 3, true));
    const points = new THREE.Points(geometry, new THREE.PointsMaterial(
      { size: 2 * renderer.getPixelRatio(), sizeAttenuation: false, vertexColors: THREE.VertexColors }));
    points.frustumCulled = false;
    return points;
  }

  // The corners' convex hull in their plane, as segments.
  function hull(corners) {
    const centre = corners.reduce((sum, corner) => sum.add(corner), new THREE.Vector3()).divideScalar(corners.length);
    const along = corners[corners.length - 1].clone().sub(corners[0]).normalize();
    const other = corners.map((corner) => corner.clone().sub(centre)).map((d) => d.addScaledVector(along, -d.dot(along)))
      .reduce((best, d) => (d.length() > best.length() ? d : best)).normalize();
    const flat = corners.map((corner) => {
      const d = corner.clone().sub(centre);
      return { corner, x: d.dot(along), y: d.dot(other) };
    }).sort((a, b) => a.x - b.x || a.y - b.y);
    const turn = (o, a, b) => (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    function half(list) {
      const chain = [];
      for (const p of list) {
        while (chain.length >= 2 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) chain.pop();
        chain.push(p);
      }
      return chain.slice(0, -1);
    }
    const ring = half(flat).concat(half(flat.slice().reverse()));
    return ring.flatMap((p, i) => [p.corner, ring[(i + 1) % ring.length].corner]);
  }
  function boards_of(scene) {
    const group = new THREE.Group();
    const told = scene.place === null ? [] : result.scenes[scene.place].boards;
    for (const board of told) {
      if (board.corners_lidar === null || board.corners_lidar.length === 0) continue;
      const corners = board.corners_lidar.map(vector);
      group.add(new THREE.Points(new THREE.BufferGeometry().setFromPoints(corners), new THREE.PointsMaterial(
        { size: 5 * renderer.getPixelRatio(), sizeAttenuation: false, color: 0xff9040 })));
      if (corners.length > 2) group.add(line_segments(hull(corners), 0xff9040));
    }
    return group;
  }

  const built = new Map();
  let current = -1;
  let cloud = null;
  let boards = null;
  const switches = { unseen: true, boards: true, sensors: true };
  function show(index) {
    current = (index + view.scenes.length) % view.scenes.length;
    const scene = view.scenes[current];
    if (!built.has(current)) built.set(current, { cloud: cloud_of(scene), boards: boards_of(scene) });
    if (cloud !== null) world.remove(cloud, boards);
    ({ cloud, boards } = built.get(current));
    world.add(cloud, boards);
    apply_switches();
    choice.value = String(current);
  }
  function apply_switches() {
    const scene = view.scenes[current];
    cloud.geometry.setDrawRange(0, switches.unseen ? scene.shown : scene.seen);
    boards.visible = switches.boards;
    sensors.visible = switches.sensors;
    draw_soon();
  }

  // --- where the eye is: about a point, by two angles and a distance

  const orbit = { target: new THREE.Vector3(), side: 0, height: 0, distance: 5 };
  function centre_of_boards() {
    const corners = view.scenes.flatMap((scene) => (scene.place === null ? [] : result.scenes[scene.place].boards))
      .flatMap((board) => board.corners_lidar || []).map(vector);
    if (corners.length === 0) return forward.clone().multiplyScalar(3);
    return corners.reduce((sum, corner) => sum.add(corner), new THREE.Vector3()).divideScalar(corners.length);
  }
  const boards_centre = centre_of_boards();
  function look_from(from, target) {
    const back = from.clone().sub(target);
    orbit.target.copy(target);
    orbit.distance = Math.max(back.length(), 0.05);
    orbit.side = Math.atan2(back.dot(right), -back.dot(forward));
    orbit.height = Math.asin(Math.max(-1, Math.min(1, back.dot(up) / orbit.distance)));
    draw_soon();
  }
  const views = {
    overview() {
      const reach = Math.max(boards_centre.length(), 1.5);
      look_from(new THREE.Vector3().addScaledVector(forward, -0.5 * reach).addScaledVector(up, 0.35 * reach)
        .addScaledVector(right, 0.45 * reach), boards_centre.clone().multiplyScalar(0.8).addScaledVector(up, 0.06 * reach));
    },
    camera() {
      const from = cameras.length > 0 ? cameras[0].origin : new THREE.Vector3();
      const towards = cameras.length > 0 ? cameras[0].z : forward;
      look_from(from, from.clone().addScaledVector(towards, Math.max(boards_centre.length(), 1)));
    },
    lidar() { look_from(new THREE.Vector3(), boards_centre); },
    above() {
      const middle = boards_centre.clone().multiplyScalar(0.5);
      look_from(middle.clone().addScaledVector(up, 1.6 * Math.max(boards_centre.length(), 1)), middle);
    },
  };
  function turn(side, height) {
    orbit.side += side;
    orbit.height = Math.max(-1.55, Math.min(1.55, orbit.height + height));
    draw_soon();
  }
  function move(sideways, upwards) {
    const e = eye.matrixWorld.elements;
    const step = 0.1 * orbit.distance;
    orbit.target.addScaledVector(new THREE.Vector3(e[0], e[1], e[2]), sideways * step)
      .addScaledVector(new THREE.Vector3(e[4], e[5], e[6]), upwards * step);
    draw_soon();
  }
  function zoom(factor) {
    orbit.distance = Math.max(0.05, Math.min(500, orbit.distance * factor));
    draw_soon();
  }

  // --- drawing

  let asked = false;
  function draw_soon() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(draw);
  }
  function draw() {
    asked = false;
    const flat = Math.cos(orbit.height) * orbit.distance;
    eye.position.copy(orbit.target).addScaledVector(forward, -flat * Math.cos(orbit.side))
      .addScaledVector(right, flat * Math.sin(orbit.side)).addScaledVector(up, Math.sin(orbit.height) * orbit.distance);
    eye.up.copy(up);
    eye.lookAt(orbit.target);
    eye.updateMatrixWorld();
    renderer.render(world, eye);
    for (const label of labels) {
      const seen = label.at.clone().project(eye);
      const visible = switches.sensors && Math.abs(seen.x) < 1 && Math.abs(seen.y) < 1 && seen.z < 1;
      label.element.style.display = visible ? "" : "none";
      // In per cent: on paper the view has another size.
      label.element.style.left = (50 * (seen.x + 1)).toFixed(2) + "%";
      label.element.style.top = (50 * (1 - seen.y)).toFixed(2) + "%";
    }
    place.dataset.state = "drawn";
    place.dataset.eye = eye.position.toArray().map((x) => x.toFixed(4)).join(" ");
  }
  function resize() {
    const width = frame.clientWidth, height = frame.clientHeight;
    if (width === 0 || height === 0) return;
    renderer.setSize(width, height, false);
    eye.aspect = width / height;
    // A view that is higher than wide shows as much from side to side.
    eye.fov = 2 * THREE.Math.radToDeg(Math.atan(Math.tan(THREE.Math.degToRad(27.5)) * Math.max(1, 1.2 / eye.aspect)));
    frame.style.setProperty("--aspect", eye.aspect.toFixed(4));
    eye.updateProjectionMatrix();
    draw_soon();
  }
  new ResizeObserver(resize).observe(frame);

  // --- controls

  const choice = make("select", { "aria-label": "Scene" });
  view.scenes.forEach((scene, index) => choice.append(make("option", { value: String(index) }, scene.name)));
  choice.addEventListener("change", () => show(Number(choice.value)));
  controls.append(choice);
  function add_button(text, action) {
    const button = make("button", { type: "button" }, text);
    button.addEventListener("click", action);
    controls.append(button);
  }
  add_button("Overview", views.overview);
  if (cameras.length > 0) add_button("From the camera", views.camera);
  add_button("From the LiDAR", views.lidar);
  add_button("From above", views.above);
  function add_switch(name, text) {
    const box = make("input", { type: "checkbox" });
    box.checked = true;
    box.addEventListener("change", () => { switches[name] = box.checked; apply_switches(); });
    controls.append(make("label", {}, box, text));
  }
  add_switch("unseen", "points no camera sees");
  add_switch("boards", "boards");
  add_switch("sensors", "sensors");

  const actions = {
    ArrowLeft: (shift) => (shift ? move(-1, 0) : turn(-0.1, 0)), ArrowRight: (shift) => (shift ? move(1, 0) : turn(0.1, 0)),
    ArrowUp: (shift) => (shift ? move(0, 1) : turn(0, 0.1)), ArrowDown: (shift) => (shift ? move(0, -1) : turn(0, -0.1)),
    "+": () => zoom(0.85), "=": () => zoom(0.85), "-": () => zoom(1 / 0.85),
    o: views.overview, c: views.camera, l: views.lidar, a: views.above,
    n: () => show(current + 1), p: () => show(current - 1),
  };
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const action = actions[event.key] || actions[event.key.toLowerCase()];
    if (action === undefined) return;
    action(event.shiftKey);
    event.preventDefault();
  });

  let drag = null;
  frame.addEventListener("pointerdown", (event) => {
    drag = { x: event.clientX, y: event.clientY };
    frame.setPointerCapture(event.pointerId);
    frame.focus({ preventScroll: true });
  });
  frame.addEventListener("pointermove", (event) => {
    if (drag === null) return;
    const dx = event.clientX - drag.x, dy = event.clientY - drag.y;
    drag = { x: event.clientX, y: event.clientY };
    if (event.shiftKey || event.buttons === 2) move(-0.02 * dx, 0.02 * dy);
    else turn(-0.006 * dx, 0.006 * dy);
  });
  for (const end of ["pointerup", "pointercancel"]) frame.addEventListener(end, () => { drag = null; });
  frame.addEventListener("contextmenu", (event) => event.preventDefault());
  frame.addEventListener("wheel", (event) => {
    if (document.activeElement !== frame) return;
    zoom(Math.exp(0.001 * event.deltaY));
    event.preventDefault();
  }, { passive: false });

  show(0);
  views.overview();
  resize();
})();

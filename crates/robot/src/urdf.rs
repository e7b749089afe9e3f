//! Arms from URDF files, as used by ROS: <http://wiki.ros.org/urdf/XML/joint>. URDF is in metres and radians, which
//! stay within this file.

use crate::arm::Frame;
use crate::arm_table::{ArmTable, Shape};
use crate::chain::{Chain, ChainError};
use glam::{DQuat, DVec3, EulerRot};
use roxmltree::{Document, Node, ParsingOptions};
use std::sync::Arc;

const MM_PER_M: f64 = 1e3;
/// Limit assigned to a joint that turns endlessly, °.
const ENDLESS: f64 = 7200.0;
/// Most elements, attributes and texts of a file; meshes are not part of it.
const MOST_NODES: u32 = 200_000;
/// Most joints between two links.
const MOST_JOINTS: usize = 100;
/// Greatest distance of an origin from the one before it, m.
const FARTHEST_M: f64 = 100.0;
/// The link that ROS-Industrial puts on the flange as defined by its maker, z outwards (REP 199).
const MAKERS_FLANGE: &str = "tool0";

/// Why a URDF file was refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UrdfError {
    /// Not XML, or not a URDF file.
    #[error("it is not a URDF file: {0}.")]
    Text(String),
    /// A xacro template, which must be expanded first.
    #[error("it is a xacro template. Make a URDF file from it: xacro robot.urdf.xacro > robot.urdf")]
    Xacro,
    /// A joint that lacks something, or has an impossible value.
    #[error("line {line}, joint \"{joint}\": {reason}.")]
    Joint {
        /// Line number, from 1.
        line: u32,
        /// Its name.
        joint: String,
        /// What is wrong.
        reason: String,
    },
    /// The joints do not form one arm of six.
    #[error("{0}.")]
    Tree(String),
    /// The axes are arranged so that no closed form fits.
    #[error("{0}.")]
    Axes(#[from] ChainError),
}

/// The links at the ends of the arm; those not given are searched for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ends {
    /// The foot; default: the link that has no parent.
    pub base: Option<String>,
    /// The flange; default: `tool0`, or the only link without a child.
    pub tip: Option<String>,
}

/// A joint as written in the file.
#[derive(Clone)]
struct Joint<'a> {
    node: Node<'a, 'a>,
    name: &'a str,
    kind: &'a str,
    parent: &'a str,
    child: &'a str,
}

/// Reads an arm of six turning joints with its limits and speeds.
///
/// # Errors
/// [`UrdfError`] with the joint or the links that are wrong.
pub fn read(text: &str, ends: &Ends) -> Result<ArmTable, UrdfError> {
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|e| UrdfError::Text(e.to_string()))?;
    let root = document.root_element();
    if root.descendants().any(|node| node.tag_name().namespace().is_some_and(|space| space.contains("xacro"))) {
        return Err(UrdfError::Xacro);
    }
    if root.tag_name().name() != "robot" {
        return Err(UrdfError::Text(format!("its outermost element is <{}>, not <robot>", root.tag_name().name())));
    }
    // Joints of <transmission> and <ros2_control> are nested deeper.
    let joints = root.children().filter(|node| node.has_tag_name("joint")).map(joint);
    arm(&way(&joints.collect::<Result<Vec<_>, _>>()?, ends)?)
}

fn joint<'a>(node: Node<'a, 'a>) -> Result<Joint<'a>, UrdfError> {
    let name = node.attribute("name").unwrap_or("without a name");
    let link = |tag: &str| {
        let link = child(node, tag).and_then(|link| link.attribute("link"));
        link.ok_or_else(|| wrong(node, format!("<{tag} link=\"…\"/> is missing")))
    };
    let kind = node.attribute("type").ok_or_else(|| wrong(node, "its type is missing".to_owned()))?;
    Ok(Joint { node, name, kind, parent: link("parent")?, child: link("child")? })
}

/// The joints from the foot to the flange.
fn way<'a>(joints: &[Joint<'a>], ends: &Ends) -> Result<Vec<Joint<'a>>, UrdfError> {
    let known = |link: &str| joints.iter().any(|j| j.parent == link || j.child == link);
    if let Some(link) = [&ends.base, &ends.tip].into_iter().flatten().find(|link| !known(link)) {
        return Err(UrdfError::Tree(format!("no joint connects the link \"{link}\"")));
    }
    let mut link = match &ends.tip {
        Some(tip) => tip,
        None if known(MAKERS_FLANGE) => MAKERS_FLANGE,
        None => last_link(joints)?,
    };
    let mut way = Vec::new();
    while ends.base.as_deref() != Some(link) {
        let Some(joint) = joints.iter().find(|j| j.child == link) else { break };
        if way.len() == MOST_JOINTS {
            return Err(UrdfError::Tree(format!("the joints form a loop, or there are more than {MOST_JOINTS}")));
        }
        way.push(joint.clone());
        link = joint.parent;
    }
    if let Some(base) = ends.base.as_deref().filter(|base| *base != link) {
        return Err(UrdfError::Tree(format!("the flange is not connected to the link \"{base}\"")));
    }
    way.reverse();
    Ok(way)
}

/// The only link without a child.
fn last_link<'a>(joints: &[Joint<'a>]) -> Result<&'a str, UrdfError> {
    let carries = |link: &str| joints.iter().any(|j| j.parent == link);
    let last: Vec<&str> = joints.iter().map(|j| j.child).filter(|link| !carries(link)).collect();
    match last[..] {
        [link] => Ok(link),
        [] => Err(UrdfError::Tree("it has no joints that end at a flange".to_owned())),
        _ => Err(UrdfError::Tree(format!(
            "several links have no link after them: {}. Name the flange as arm.tip in a cell",
            last.join(", ")
        ))),
    }
}

/// The arm formed by the joints of the chain; fixed ones are merged into the next.
fn arm(way: &[Joint<'_>]) -> Result<ArmTable, UrdfError> {
    let still = Frame { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
    let (mut before, mut turning) = (still, Vec::new());
    for joint in way {
        before = before.then(&origin(joint)?);
        if joint.kind != "fixed" {
            let axis = axis(joint)?;
            turning.push((std::mem::replace(&mut before, still), axis, limits(joint)?));
        }
    }
    let count = turning.len();
    let turning: [_; 6] = turning.try_into().map_err(|_| {
        let names: Vec<&str> = way.iter().filter(|j| j.kind != "fixed").map(|j| j.name).collect();
        let found = if count == 0 { "none".to_owned() } else { format!("{count}: {}", names.join(", ")) };
        UrdfError::Tree(format!("six turning joints are needed from foot to flange, but there are {found}"))
    })?;
    let chain = Chain::new(&turning.map(|(frame, axis, _)| (frame, axis)), &before)?;
    let speeds = turning.map(|(_, _, (_, speed))| speed);
    Ok(ArmTable { shape: Shape::Chain(Arc::new(chain)), limits: turning.map(|(_, _, (limits, _))| limits), speeds })
}

fn origin(joint: &Joint<'_>) -> Result<Frame, UrdfError> {
    let node = child(joint.node, "origin");
    let [position, turns] = ["xyz", "rpy"].map(|name| match node.and_then(|node| node.attribute(name)) {
        Some(text) => three(joint, name, text),
        None => Ok(DVec3::ZERO),
    });
    let (position, turns) = (position?, turns?);
    if position.abs().max_element() > FARTHEST_M {
        return Err(wrong(joint.node, format!("its origin lies more than {FARTHEST_M} m away")));
    }
    let rotation = DQuat::from_euler(EulerRot::ZYX, turns.z, turns.y, turns.x);
    Ok(Frame { position: position * MM_PER_M, rotation })
}

/// The direction of the axis; x if the file gives none.
fn axis(joint: &Joint<'_>) -> Result<DVec3, UrdfError> {
    let Some(text) = child(joint.node, "axis").and_then(|node| node.attribute("xyz")) else { return Ok(DVec3::X) };
    let axis = three(joint, "xyz", text)?.try_normalize();
    axis.ok_or_else(|| wrong(joint.node, "its axis has no direction".to_owned()))
}

/// Least and greatest angle, °, and greatest speed, °/s.
fn limits(joint: &Joint<'_>) -> Result<([f64; 2], f64), UrdfError> {
    let Joint { node, kind, .. } = joint;
    if !matches!(*kind, "revolute" | "continuous") {
        return Err(wrong(*node, format!("its type is {kind}; only revolute, continuous and fixed joints are walked")));
    }
    if child(*node, "mimic").is_some() {
        return Err(wrong(*node, "it follows another joint (mimic); each joint must turn on its own".to_owned()));
    }
    let value = |name: &str| {
        let value = child(*node, "limit").and_then(|limit| limit.attribute(name)).and_then(number);
        let value = value.filter(|v| v.to_degrees().abs() <= 1e5).map(f64::to_degrees);
        value.ok_or_else(|| wrong(*node, format!("<limit {name}=\"…\"/> is missing or not a number")))
    };
    let speed = value("velocity")?;
    if speed <= 0.0 {
        return Err(wrong(*node, "its greatest speed must be above 0".to_owned()));
    }
    let range = if *kind == "continuous" { [-ENDLESS, ENDLESS] } else { [value("lower")?, value("upper")?] };
    if range[0] >= range[1] {
        return Err(wrong(*node, "its lower limit is not below its upper one".to_owned()));
    }
    Ok((range, speed))
}

fn three(joint: &Joint<'_>, name: &str, text: &str) -> Result<DVec3, UrdfError> {
    let values: Option<Vec<f64>> = text.split_whitespace().map(number).collect();
    match values.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err(wrong(joint.node, format!("{name}=\"{text}\" must be three numbers"))),
    }
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|v: &f64| v.is_finite())
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|node| node.has_tag_name(tag))
}

fn wrong(node: Node<'_, '_>, reason: String) -> UrdfError {
    let line = node.document().text_pos_at(node.range().start).row;
    UrdfError::Joint { line, joint: node.attribute("name").unwrap_or("without a name").to_owned(), reason }
}

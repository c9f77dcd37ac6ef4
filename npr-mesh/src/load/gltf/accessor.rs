//! Reads numbers from buffers with bounds checks (glTF 2.0, 3.6.2 "Accessors").

use super::document::Document;
use super::extensions::QUANTIZATION;
use super::files;
use super::slice::slice;
use gltf::json::accessor::{ComponentType, Type, sparse};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};

/// An accessor whose elements are within their buffers.
///
/// Without a buffer view all elements are zero; the caller must then limit their number before reading.
pub(super) struct Accessor<'d> {
    number: usize,
    /// The number of elements.
    pub count: u64,
    /// The number of elements stated in the file.
    stated: u64,
    /// Whether the accessor has a buffer view.
    pub stored: bool,
    /// The number of components of an element.
    pub lanes: usize,
    component: ComponentType,
    normalized: bool,
    bytes: &'d [u8],
    /// The distance between elements in bytes.
    stride: usize,
    sparse: Option<Sparse<'d>>,
}

/// Sparse elements, which replace others.
struct Sparse<'d> {
    indices: &'d [u8],
    index_type: ComponentType,
    values: &'d [u8],
}

/// The use of an accessor, which determines the allowed component types (glTF 2.0, 3.7.2.1 "Overview", 3.7.3.1
/// "Skins", and `KHR_mesh_quantization`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Purpose {
    Position,
    Normal,
    TexCoord,
    /// Colours and joint weights.
    Fraction,
    Displacement,
    Joints,
    Indices,
    /// Matrices, and the translations and scales of instances.
    Matrices,
    /// Rotations of instances.
    Rotation,
    /// A bit field in bytes.
    Bits,
    /// The normals of `EXT_mesh_primitive_edge_visibility`, floats or normalised signed bytes.
    Direction,
}

impl Purpose {
    /// Whether the component type is allowed, and whether it requires `KHR_mesh_quantization`.
    fn allows(self, component: ComponentType, normalized: bool) -> (bool, bool) {
        use ComponentType::{F32, I8, I16, U8, U16, U32};
        let unsigned = matches!(component, U8 | U16);
        let signed = matches!(component, I8 | I16);
        match self {
            Purpose::Position => (component != U32, component != F32),
            Purpose::Normal => (component == F32 || (signed && normalized), component != F32),
            Purpose::Displacement => (component == F32 || signed, component != F32),
            Purpose::TexCoord => (component != U32, !(component == F32 || (unsigned && normalized))),
            // Some files omit the normalised flag, although no other meaning is allowed.
            Purpose::Fraction => (component == F32 || unsigned, false),
            Purpose::Joints => (unsigned, false),
            Purpose::Indices => (unsigned || component == U32, false),
            Purpose::Matrices => (component == F32, false),
            Purpose::Rotation => (component == F32 || (signed && normalized), false),
            Purpose::Bits => (component == U8, false),
            Purpose::Direction => (matches!(component, F32 | I8), false),
        }
    }
}

/// The conversion of integers to floats.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Integers {
    /// As stated by the accessor.
    AsStated,
    /// Always normalised, for attributes that allow nothing else in files that omit the flag.
    Normalized,
}

impl<'d> Accessor<'d> {
    /// Looks up an accessor and checks its bounds.
    ///
    /// # Errors
    /// The fault with the index of the accessor.
    pub fn new(document: &'d Document, index: Index<json::Accessor>, purpose: Purpose) -> Result<Self, String> {
        let number = index.value();
        // Those of extensions are not among the indices that are checked at first.
        let accessor =
            document.root.accessors.get(number).ok_or_else(|| format!("accessor {number} does not exist"))?;
        let fail = |fault: String| format!("accessor {number}: {fault}");
        let Checked::Valid(component) = accessor.component_type else {
            return Err(fail("unknown component type".to_owned()));
        };
        let Checked::Valid(kind) = accessor.type_ else { return Err(fail("unknown type".to_owned())) };
        // Small matrices have padded columns. The only matrices that are read here consist of floats.
        if matches!(kind, Type::Mat2 | Type::Mat3) {
            return Err(fail("a 2x2 or 3x3 matrix, which no attribute is".to_owned()));
        }
        let (component, lanes, count) = (component.0, kind.multiplicity(), accessor.count.0);
        match purpose.allows(component, accessor.normalized) {
            (false, _) => {
                return Err(fail(format!("{} are not allowed here", type_name(component, accessor.normalized))));
            }
            (true, true) if !document.quantized => {
                let what = type_name(component, accessor.normalized);
                return Err(fail(format!("{what}, and the file does not say that it uses {QUANTIZATION}")));
            }
            _ => {}
        }
        let element = component.size() * lanes;
        let mut found = Self {
            number,
            count,
            stated: count,
            stored: false,
            lanes,
            component,
            normalized: accessor.normalized,
            bytes: &[],
            stride: element,
            sparse: None,
        };
        if let Some(view) = accessor.buffer_view {
            let (bytes, stride) = files::view(document, view).map_err(fail)?;
            found.stride = stride.unwrap_or(element);
            if found.stride < element {
                return Err(fail(format!("elements of {element} bytes every {} bytes", found.stride)));
            }
            let length = (count.saturating_sub(1)).checked_mul(found.stride as u64);
            let length = length.and_then(|l| l.checked_add(if count == 0 { 0 } else { element as u64 }));
            let offset = accessor.byte_offset.unwrap_or_default().0;
            found.bytes = length.and_then(|length| slice(bytes, offset, length)).ok_or_else(|| {
                fail(format!(
                    "{count} elements of {element} bytes every {} bytes from byte {offset} reach beyond buffer view \
                     {}, which has {} bytes",
                    found.stride,
                    view.value(),
                    bytes.len()
                ))
            })?;
            found.stored = true;
        }
        if let Some(sparse) = &accessor.sparse {
            if sparse.count.0 > count {
                return Err(fail(format!("{} sparse elements of {count}", sparse.count.0)));
            }
            found.sparse = Some(Sparse::new(document, sparse, element as u64).map_err(fail)?);
        }
        Ok(found)
    }

    /// Truncates the accessor to the first `count` elements.
    pub fn first(mut self, count: u64) -> Self {
        if count < self.count {
            self.bytes = &self.bytes[..self.bytes.len().min(count as usize * self.stride)];
            self.count = count;
        }
        self
    }

    /// All elements as `N` floats each.
    ///
    /// # Errors
    /// Another number of components, or a component type that is not allowed for attributes.
    pub fn floats<const N: usize>(&self, integers: Integers) -> Result<Vec<[f32; N]>, String> {
        let normalized = self.normalized || integers == Integers::Normalized;
        match (self.component, normalized) {
            (ComponentType::F32, _) => self.elements(f32::from_le_bytes),
            (ComponentType::U8, false) => self.elements(|[b]| f32::from(b)),
            (ComponentType::U8, true) => self.elements(|[b]| f32::from(b) / 255.0),
            (ComponentType::I8, false) => self.elements(|[b]| f32::from(b as i8)),
            (ComponentType::I8, true) => self.elements(|[b]| (f32::from(b as i8) / 127.0).max(-1.0)),
            (ComponentType::U16, false) => self.elements(|b| f32::from(u16::from_le_bytes(b))),
            (ComponentType::U16, true) => self.elements(|b| f32::from(u16::from_le_bytes(b)) / 65535.0),
            (ComponentType::I16, false) => self.elements(|b| f32::from(i16::from_le_bytes(b))),
            (ComponentType::I16, true) => self.elements(|b| (f32::from(i16::from_le_bytes(b)) / 32767.0).max(-1.0)),
            (ComponentType::U32, _) => Err(self.fault("32-bit integers, which only indices may be")),
        }
    }

    /// The largest number of the component type if that is unsigned, which separates line strings.
    pub fn largest_integer(&self) -> u32 {
        match self.component {
            ComponentType::U8 => u8::MAX.into(),
            ComponentType::U16 => u16::MAX.into(),
            _ => u32::MAX,
        }
    }

    /// All elements as `N` unsigned integers each.
    ///
    /// # Errors
    /// Another number of components, or another component type.
    pub fn integers<const N: usize>(&self) -> Result<Vec<[u32; N]>, String> {
        match self.component {
            ComponentType::U8 => self.elements(|[b]| u32::from(b)),
            ComponentType::U16 => self.elements(|b| u32::from(u16::from_le_bytes(b))),
            ComponentType::U32 => self.elements(u32::from_le_bytes),
            _ => Err(self.fault("not unsigned integers")),
        }
    }

    fn elements<const N: usize, const SIZE: usize, T: Copy + Default>(
        &self,
        convert: impl Fn([u8; SIZE]) -> T,
    ) -> Result<Vec<[T; N]>, String> {
        if self.lanes != N {
            return Err(self.fault(&format!("{} numbers in an element, expected {N}", self.lanes)));
        }
        let element = SIZE * N;
        let read = |bytes: &[u8]| {
            let (numbers, _) = bytes.as_chunks::<SIZE>();
            std::array::from_fn(|lane| convert(numbers[lane]))
        };
        let count = usize::try_from(self.count).map_err(|_| self.fault("more elements than there is memory"))?;
        let mut elements: Vec<[T; N]> = if !self.stored {
            vec![[T::default(); N]; count]
        } else if self.stride == element {
            self.bytes.chunks_exact(element).map(read).collect()
        } else {
            // The last element may be shorter than the stride.
            self.bytes.chunks(self.stride).map(|bytes| read(&bytes[..element])).collect()
        };
        if let Some(sparse) = &self.sparse {
            for (at, value) in sparse.indices().zip(sparse.values.chunks_exact(element)) {
                match elements.get_mut(at as usize) {
                    Some(slot) => *slot = read(value),
                    None if u64::from(at) < self.stated => {}
                    None => return Err(self.fault(&format!("sparse index {at} of {count} elements"))),
                }
            }
        }
        Ok(elements)
    }

    /// A message about this accessor.
    pub fn fault(&self, fault: &str) -> String {
        format!("accessor {}: {fault}", self.number)
    }
}

fn type_name(component: ComponentType, normalized: bool) -> String {
    let name = match component {
        ComponentType::I8 => "signed 8-bit integers",
        ComponentType::U8 => "unsigned 8-bit integers",
        ComponentType::I16 => "signed 16-bit integers",
        ComponentType::U16 => "unsigned 16-bit integers",
        ComponentType::U32 => "unsigned 32-bit integers",
        ComponentType::F32 => "floats",
    };
    format!("{name}{}", if normalized { ", normalised" } else { "" })
}

impl<'d> Sparse<'d> {
    fn new(document: &'d Document, sparse: &sparse::Sparse, element: u64) -> Result<Self, String> {
        let Checked::Valid(index_type) = sparse.indices.component_type else {
            return Err("sparse indices of an unknown component type".to_owned());
        };
        let (index_type, count) = (index_type.0, sparse.count.0);
        let part = |what: &str, view, offset: u64, size: u64| {
            let (bytes, _) = files::view(document, view)?;
            let length = count.checked_mul(size);
            length.and_then(|length| slice(bytes, offset, length)).ok_or_else(|| {
                format!("{count} sparse {what} from byte {offset} reach beyond buffer view {}", view.value())
            })
        };
        let (indices, values) = (&sparse.indices, &sparse.values);
        Ok(Self {
            indices: part("indices", indices.buffer_view, indices.byte_offset.0, index_type.size() as u64)?,
            index_type,
            values: part("values", values.buffer_view, values.byte_offset.0, element)?,
        })
    }

    fn indices(&self) -> impl Iterator<Item = u32> + '_ {
        self.indices.chunks_exact(self.index_type.size()).map(|bytes| {
            let mut word = [0; 4];
            word[..bytes.len()].copy_from_slice(bytes);
            u32::from_le_bytes(word)
        })
    }
}

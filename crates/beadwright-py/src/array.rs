//! Numbers of the library as Python sees them, by the buffer protocol: `numpy.asarray` takes their memory as it is.

use glam::DVec3;
use pyo3::exceptions::PyBufferError;
use pyo3::ffi;
use pyo3::prelude::*;
use std::ffi::{CStr, c_int};

/// Holds numbers that stay where they are for as long as it lives.
pub(crate) trait Numbers: Send + Sync + 'static {
    /// Their bytes.
    fn bytes(&self) -> &[u8];
}

impl Numbers for Vec<f64> {
    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self)
    }
}

impl Numbers for Vec<DVec3> {
    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self)
    }
}

/// What one number is: 64-bit floating point, or an unsigned 32-bit integer.
#[derive(Clone, Copy)]
pub(crate) enum Item {
    Float,
    Index,
}

impl Item {
    fn size(self) -> isize {
        match self {
            Self::Float => 8,
            Self::Index => 4,
        }
    }

    fn format(self) -> &'static CStr {
        match self {
            Self::Float => c"d",
            Self::Index => c"I",
        }
    }
}

/// Numbers that cannot be changed, in one or two dimensions.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Array {
    numbers: Box<dyn Numbers>,
    item: Item,
    shape: Vec<isize>,
    /// Bytes from one entry to the next, in each dimension.
    strides: Vec<isize>,
}

impl Array {
    /// One number after another.
    pub(crate) fn list(numbers: impl Numbers) -> Self {
        let count = numbers.bytes().len() as isize / Item::Float.size();
        Self { numbers: Box::new(numbers), item: Item::Float, shape: vec![count], strides: vec![Item::Float.size()] }
    }

    /// Rows of `columns` numbers.
    pub(crate) fn rows(numbers: impl Numbers, item: Item, columns: isize) -> Self {
        let row = columns * item.size();
        let shape = vec![numbers.bytes().len() as isize / row, columns];
        Self { numbers: Box::new(numbers), item, shape, strides: vec![row, item.size()] }
    }

    /// Places, a row of three numbers each.
    pub(crate) fn places(places: Vec<DVec3>) -> Self {
        Self::rows(places, Item::Float, 3)
    }

    /// One number, seen `count` times.
    pub(crate) fn same(number: impl Numbers, count: usize) -> Self {
        Self { numbers: Box::new(number), item: Item::Float, shape: vec![count as isize], strides: vec![0] }
    }
}

#[pymethods]
impl Array {
    #[expect(unsafe_code, reason = "the buffer protocol hands out pointers")]
    unsafe fn __getbuffer__(slf: Bound<'_, Self>, view: *mut ffi::Py_buffer, flags: c_int) -> PyResult<()> {
        let array = slf.get();
        let asks = |wanted: c_int| flags & wanted == wanted;
        if view.is_null() || asks(ffi::PyBUF_WRITABLE) {
            return Err(PyBufferError::new_err("the numbers of a plan cannot be written"));
        }
        let whole = array.strides.first() != Some(&0);
        let contiguous = [ffi::PyBUF_C_CONTIGUOUS, ffi::PyBUF_ANY_CONTIGUOUS].into_iter().any(asks);
        if asks(ffi::PyBUF_F_CONTIGUOUS) && array.shape.len() > 1 || !whole && (contiguous || !asks(ffi::PyBUF_STRIDES))
        {
            return Err(PyBufferError::new_err("the numbers are not laid out in memory as requested"));
        }
        let item = array.item;
        // SAFETY: `view` is not null, and Python lets us fill it in. The pointers lead into the frozen array, whose numbers
        // stay in place while it lives; `obj` keeps it alive until the buffer is given back.
        unsafe {
            let view = &mut *view;
            view.buf = array.numbers.bytes().as_ptr().cast_mut().cast();
            view.len = array.shape.iter().product::<isize>() * item.size();
            view.itemsize = item.size();
            view.readonly = 1;
            view.ndim = array.shape.len() as c_int;
            view.format = std::ptr::null_mut();
            view.shape = std::ptr::null_mut();
            view.strides = std::ptr::null_mut();
            view.suboffsets = std::ptr::null_mut();
            view.internal = std::ptr::null_mut();
            if asks(ffi::PyBUF_FORMAT) {
                view.format = item.format().as_ptr().cast_mut();
            }
            if asks(ffi::PyBUF_ND) {
                view.shape = array.shape.as_ptr().cast_mut();
            }
            if asks(ffi::PyBUF_STRIDES) {
                view.strides = array.strides.as_ptr().cast_mut();
            }
            view.obj = slf.into_any().into_ptr();
        }
        Ok(())
    }

    /// Where the numbers lie in the library's memory.
    #[getter]
    fn address(&self) -> usize {
        self.numbers.bytes().as_ptr() as usize
    }
}
